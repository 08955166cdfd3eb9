"""Small data sets of every layout, made by the program, and what their manifests say of them.

Each test program here is run as NAME_test.py SHIMMER. main() skips it (exit code 77) where a module is missing.
"""

import hashlib
import importlib
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SKIPPED = 77  # as tests/CMakeLists.txt knows it
REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
LAYOUTS = ("sequence", "pairs", "restormer", "basicsr", "webdataset")
KINDS = {"turb": "turb", "lq": "turb", "clean": "clean", "noturb": "clean", "gt": "clean", "truth": "truth",
         "mask": "mask", "flow": "flow", "shake": "shake", "shake.json": "shake"}

program = None  # the path of shimmer, from the command line


def main(*modules):
    """Runs the tests of the file that calls it, which needs the modules."""
    global program
    program = pathlib.Path(sys.argv.pop(1)).resolve()
    for module in modules:
        try:
            importlib.import_module(module)
        except ImportError:
            print(f"skipped: needs {module} (scripts/setup.sh --training)")
            sys.exit(SKIPPED)
    unittest.main(module="__main__")


class SetsTest(unittest.TestCase):
    """A test with a folder of its own, in which it makes data sets."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="shimmer-loaders-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def make(self, name, layout, source=None, arguments=(), **keys):
        """Makes the data set self.folder/name. Keys are those of the config, "output.bits" written output_bits."""
        config = {
            "seed": 5, "clips": 4, "frames": 3, "size": [48, 40],
            "source": source or {"drawn": {"choice": ["chart", "bricks", "text", "star"]}},
            "tilt": {"strength_px": 3, "octaves": 3}, "blur": {"max_sigma_px": 1, "octaves": 3},
            "output": {"layout": layout, "truth": ["tilt", "sigma"]}}
        if layout == "basicsr":
            config["output"]["any_length"] = True
        for key, value in keys.items():
            room, _, leaf = key.partition("_")
            if room in ("output", "tilt", "blur"):
                config[room][leaf] = value
            else:
                config[key] = value
        path = self.folder / f"{name}.json"
        path.write_text(json.dumps(config))
        done = subprocess.run([program, "generate", path, "--out", self.folder / name, "--quiet", *arguments],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.folder / name

    def moving_source(self, frames, size=(64, 56), dtype="uint8"):
        """A config's source whose clean frames all differ: smooth waves that move. Without numpy it can't be made."""
        import cv2
        import numpy
        folder = self.folder / f"moving_{dtype}"
        folder.mkdir()
        y, x = numpy.mgrid[:size[1], :size[0]]
        top = numpy.iinfo(dtype).max
        for frame in range(frames):
            waves = [numpy.sin(x / 7 + frame + c) * numpy.sin(y / (5 + c) - frame) for c in range(3)]
            cv2.imwrite(str(folder / f"{frame:04}.png"), ((numpy.stack(waves, 2) + 1) / 2 * top).astype(dtype))
        return {"sequence": str(folder), "start": "first"}


def lines_of(folder):
    """The manifest's lines of a set that is complete, by clip."""
    lines = map(json.loads, (folder / "manifest.jsonl").read_text().splitlines())
    return {line["clip"]: line for line in lines}


def files_of(line, kind):
    """A clip's files of a kind, in the order of their numbers. Knows kinds by their names alone, in any layout."""
    def kind_of(file):
        if "member" in file:
            return KINDS.get(file["member"].split(".")[1])  # a sample's json is none of them
        return [KINDS[part] for part in file["path"].split("/") if part in KINDS][-1]
    files = [file for file in line["files"] if kind_of(file) == kind]
    return sorted(files, key=lambda file: file.get("member", file["path"]))


def pixel_hash(samples):
    """As docs/formats.md defines it, of an array [y][x][channel]."""
    height, width, channels = samples.shape
    line = f"{width} {height} {channels} {samples.dtype.name}\n"
    return hashlib.sha256(line.encode() + samples.tobytes()).hexdigest()
