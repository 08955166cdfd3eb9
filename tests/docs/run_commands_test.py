#!/usr/bin/python3
"""The runner of the pages' commands: each thing that it is to find, in a page that has it.

  run_commands_test.py SHIMMER
"""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True

from run_commands import Fault, run_page

PROGRAM = None  # from the command line


def page(*blocks):
    """A page of blocks, each (what follows the backticks, text)."""
    return "Words.\n\n" + "".join(f"```{head}\n{text}\n```\n\n" for head, text in blocks)


class RunCommands(unittest.TestCase):
    def run_text(self, text, update=False):
        """Returns what was skipped, and the page afterwards."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "page.md"
            path.write_text(text)
            return run_page(path, PROGRAM, update), path.read_text()

    def assert_fault(self, words, text):
        with self.assertRaisesRegex(Fault, words):
            self.run_text(text)

    def test_a_good_page_passes(self):
        skipped, _ = self.run_text(page(
            ("json file=a.json", '{"a": 1}'),
            ("sh makes=b.txt", "cat a.json | tee b.txt; echo end of it"),
            ("text output", "...\nend ... it"),
            ("sh exit=3", "exit 3"),
            ("sh", "ls photos/photo0.png road.mp4 && shimmer --version"),
            ("text exact", "photos/photo0.png\nroad.mp4\nshimmer 0.1.0"),
            ("sh check-only", "scripts/demo.sh   # not run"),
            ("python", "print(sum(range(4)))"),
            ("text output", "6"),
            ("text", "only words")))
        self.assertEqual(skipped, [])

    def test_exit_codes(self):
        self.assert_fault("line 3.*exit code 1, must be 0", page(("sh", "false; true")))
        self.assert_fault("exit code 1, must be 0", page(("sh", "false | true")))
        self.assert_fault("exit code 0, must be 2", page(("sh exit=2", "true")))
        self.assert_fault("exit code 1, must be 0", page(("python", "assert 1 > 2")))

    def test_outputs(self):
        self.assert_fault("'b' was not printed", page(("sh", "echo a"), ("text output", "b")))
        self.assert_fault("not in this order", page(("sh", "echo a; echo b"), ("text output", "b\na")))
        self.assert_fault("was not printed", page(("sh", "echo ab"), ("text output", "a")))
        self.assert_fault("differs", page(("sh", "echo a; echo b"), ("text exact", "a")))
        self.assert_fault("is not there afterwards", page(("sh makes=x", "true")))
        self.assert_fault("is not there afterwards", page(("sh makes=x", ": > x")))

    def test_blocks(self):
        self.assert_fault("unknown kind of block", page(("bash", "true")))
        self.assert_fault("line 3 .json.", page(("json", "{,}")))
        self.assert_fault("names no script", page(("sh check-only", "true")))
        self.assert_fault("names scripts/absent.sh", page(("sh check-only", "scripts/absent.sh")))
        self.assert_fault("is not there or can't", page(("sh check-only", "scripts/absent")))
        with self.assertRaisesRegex(ValueError, "never closed"):
            self.run_text("```sh\ntrue\n")

    def test_references(self):
        self.assert_fault("link to gone.md", "[words](gone.md)")
        self.assert_fault("names sim/gone.h", "as in sim/gone.h")
        self.assert_fault("names the test Warp.IsGone", "see `Warp.IsGone`")
        self.run_text("[words](https://example.org/x), sim/warp.h, `Warp.EqualsItsDoubleTwinOnNoise`")

    def test_a_missing_module_is_skipped_and_its_output_too(self):
        skipped, _ = self.run_text(page(("python", "import no_such_module_as_this"), ("text output", "x")))
        self.assertEqual(len(skipped), 1)
        self.assertIn("no_such_module_as_this", skipped[0])
        skipped, _ = self.run_text(page(("sh needs=json,no_such_module_as_this", "exit 1"), ("text output", "x")))
        self.assertEqual(len(skipped), 1)
        self.assertIn("needs no_such_module_as_this", skipped[0])

    def test_modules_may_lie_in_the_folder(self):
        skipped, _ = self.run_text(page(
            ("sh", "echo 'value = 7' > its_own.py"),
            ("python", "import its_own; print(its_own.value)"),
            ("text output", "7"),
            ("sh needs=json,its_own", "echo runs"),
            ("text output", "runs")))
        self.assertEqual(skipped, [])

    def test_update_writes_exact_blocks_and_nothing_else(self):
        before = page(("sh", "echo a; echo b"), ("text exact", "old"), ("sh", "echo c"), ("text exact", "1\n2\n3"))
        _, after = self.run_text(before, update=True)
        self.assertEqual(after, page(("sh", "echo a; echo b"), ("text exact", "a\nb"), ("sh", "echo c"),
                                     ("text exact", "c")))


if __name__ == "__main__":
    PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
