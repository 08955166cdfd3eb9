#!/usr/bin/python3
"""Runs every command of documentation pages, in order, in a folder that is thrown away afterwards.

  run_commands.py --program build/release/bin/shimmer README.md docs/guide.md
  run_commands.py --update ...    writes what `text exact` blocks must say into the pages

The folder has what a reader has: the program in PATH, configs/ and scripts/ of the repository, photographs in
photos/ and a video road.mp4 (samples.py). docs/build.md says what the blocks' first lines mean.
"""

import argparse
import ast
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True

import samples
from blocks import blocks_of, with_text
from references import missing_references

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
PYTHON = "/usr/bin/python3"  # of Debian, which has its packages (numpy, OpenImageIO)
SECONDS = 120  # for one block; a page takes far less


class Fault(Exception):
    """What is wrong with a page, in words."""


class Runner:
    """Runs the blocks of one page. Collects texts for --update, and what was skipped."""

    def __init__(self, folder, program):
        self.folder, self.printed, self.updates, self.skipped = folder, None, [], []
        self.environment = dict(os.environ, PATH=f"{program.parent}:{os.environ['PATH']}")

    def run(self, block, update):
        if block.language == "sh" and "check-only" in block.tags:
            self.check_scripts(block)
        elif block.language == "sh":
            self.execute(block, ["bash", "-euo", "pipefail", "-c", block.text],
                         filter(None, block.tags.get("needs", "").split(",")))
        elif block.language == "python":
            self.execute(block, [PYTHON, "-c", block.text], imports_of(block.text))
        elif block.language == "json":
            self.write_json(block)
        elif block.language != "text":
            raise Fault("unknown kind of block: sh, python, json and text are the kinds there are")
        elif "exact" in block.tags and update:
            self.updates.append((block, self.printed))
        elif "output" in block.tags or "exact" in block.tags:
            self.compare(block)

    def execute(self, block, command, modules):
        """Skips the block, and with it what is compared with its output, if a module is missing."""
        absent = [name for name in modules if not self.has(name)]
        if absent:
            self.printed = None
            self.skipped.append(f"{block}: needs {', '.join(absent)} (scripts/setup.sh --all)")
            return
        done = subprocess.run(command, cwd=self.folder, env=self.environment, text=True, timeout=SECONDS,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.printed = done.stdout
        expected = int(block.tags.get("exit", 0))
        if done.returncode != expected:
            raise Fault(f"exit code {done.returncode}, must be {expected}; it printed:\n{done.stdout}")
        for name in filter(None, block.tags.get("makes", "").split(",")):
            path = self.folder / name
            if not path.exists() or (path.is_file() and path.stat().st_size == 0):
                raise Fault(f"{name} is not there afterwards")

    def has(self, module):
        """Modules may also lie in the page's folder."""
        command = [PYTHON, "-B", "-c", f"import {module}"]
        return subprocess.run(command, cwd=self.folder, capture_output=True).returncode == 0

    # Blocks that install packages, or that build and test all of this, of which this very test is a part: they
    # would take minutes, change the machine, and run themselves. What is checked here is that their scripts exist
    # and parse.
    def check_scripts(self, block):
        subprocess.run(["bash", "-n", "-c", block.text], check=True)
        scripts = re.findall(r"(?m)^\s*(scripts/\S+)", block.text)
        if not scripts:
            raise Fault("names no script of the repository")
        for script in scripts:
            if not os.access(REPOSITORY / script, os.X_OK):
                raise Fault(f"{script} is not there or can't be executed")
            subprocess.run(["bash", "-n", str(REPOSITORY / script)], check=True)

    def write_json(self, block):
        for value in block.text.splitlines() if "lines" in block.tags else [block.text]:
            json.loads(value)
        if "file" in block.tags:
            (self.folder / block.tags["file"]).write_text(block.text)

    def compare(self, block):
        if self.printed is None:
            return  # what it is the output of was skipped
        if "exact" in block.tags:
            if self.printed != block.text:
                raise Fault(f"differs from what is printed (run_commands.py --update mends it):\n{self.printed}")
            return
        # Each line must be there, in this order; "..." stands for anything.
        at = 0
        for line in block.text.splitlines():
            if line.strip() == "...":
                continue
            pattern = "^" + ".*".join(map(re.escape, line.split("..."))) + "$"
            found = re.compile(pattern, re.M).search(self.printed, at)
            if not found:
                raise Fault(f"'{line}' was not printed, or not in this order; what was printed:\n{self.printed}")
            at = found.end()


def imports_of(program):
    """Names of the modules that a Python program imports, sorted."""
    modules = set()
    for node in ast.walk(ast.parse(program)):
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            modules.add(node.module)
    return sorted(modules)


def run_page(path, program, update):
    """Returns what was skipped. Raises Fault."""
    page = path.read_text()
    if missing := missing_references(path, page, REPOSITORY):
        raise Fault("\n".join(f"{path}: {line}" for line in missing))
    with tempfile.TemporaryDirectory(prefix="shimmer-docs-") as name:
        folder = pathlib.Path(name)
        for shown in ("configs", "scripts"):
            (folder / shown).symlink_to(REPOSITORY / shown)
        samples.make(folder, program)
        runner = Runner(folder, program)
        for block in blocks_of(page):
            try:
                runner.run(block, update)
            except (Fault, ValueError, SyntaxError, subprocess.SubprocessError) as fault:
                raise Fault(f"{path}: {block}: {fault}") from fault
    for block, text in reversed(runner.updates):  # from the end, so that lines keep their numbers
        page = with_text(page, block, text)
    if runner.updates:
        path.write_text(page)
    return runner.skipped


def main():
    arguments = argparse.ArgumentParser(description="Runs every command of documentation pages.")
    arguments.add_argument("--program", type=pathlib.Path, default=REPOSITORY / "build/release/bin/shimmer")
    arguments.add_argument("--update", action="store_true", help="write what `text exact` blocks must say")
    arguments.add_argument("pages", type=pathlib.Path, nargs="+")
    given = arguments.parse_args()
    for path in given.pages:
        try:
            for skipped in run_page(path, given.program.resolve(), given.update):
                print(f"{path}: skipped: {skipped}")
        except Fault as fault:
            sys.exit(str(fault))


if __name__ == "__main__":
    main()
