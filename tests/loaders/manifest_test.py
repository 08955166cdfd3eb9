#!/usr/bin/python3
"""scripts/train/shimmer_dataset.py on manifests as they are during a run, after kills, of shards; and on damaged sets.

  manifest_test.py SHIMMER
"""

import json
import subprocess
import sys

sys.dont_write_bytecode = True

import sets

SCRIPT = sets.REPOSITORY / "scripts/train/shimmer_dataset.py"
sys.path.insert(0, str(SCRIPT.parent))


class Manifests(sets.SetsTest):
    """Over a set of four clips, whose manifest is written anew."""

    def setUp(self):
        super().setUp()
        self.set = self.make("set", "sequence", frames=2, size=[16, 16])
        self.lines = [json.dumps(line) + "\n" for _, line in sorted(sets.lines_of(self.set).items())]
        (self.set / "manifest.jsonl").unlink()

    def write(self, *lines, name="manifest.jsonl"):
        (self.set / name).write_text("".join(lines))

    def failed(self, clip):
        return json.dumps({"clip": clip, "status": "failed", "error": "no such picture"}) + "\n"

    def clips(self):
        from shimmer_dataset import ShimmerDataset
        dataset = ShimmerDataset(self.set, frames="all")
        self.assertEqual([len(turb) for turb, _ in dataset], [2] * len(dataset))
        return [dataset.line(index)["clip"] for index in range(len(dataset))]

    def test_clips_come_in_their_order(self):
        self.write(*reversed(self.lines))
        self.assertEqual(self.clips(), [0, 1, 2, 3])

    def test_a_set_grows_while_it_is_read(self):
        from shimmer_dataset import ShimmerDataset
        self.write(*self.lines[:2])
        dataset = ShimmerDataset(self.set)
        self.write(*self.lines)
        self.assertEqual((len(dataset), len(list(dataset))), (4, 4))
        self.assertEqual(self.clips(), [0, 1, 2, 3])

    def test_a_torn_last_line_is_not_there(self):
        line = self.lines[2]
        for torn in (line[:-1], line[:40], line[:40] + "\n", "{", "\0\0"):
            self.write(self.lines[0], self.lines[1], torn)
            self.assertEqual(self.clips(), [0, 1])

    def test_what_follows_a_zero_byte_is_not_there(self):
        self.write(self.lines[0], "\0" * 100 + "\n", self.lines[2])
        self.assertEqual(self.clips(), [0])

    def test_a_copy_is_no_manifest_of_a_shard(self):
        self.write(*self.lines[:2])
        self.write(*self.lines, name="manifest.bak.jsonl")
        self.assertEqual(self.clips(), [0, 1])

    def test_a_damaged_line_elsewhere_is_an_error(self):
        self.write(self.lines[0], self.lines[1][:-9] + "\n", self.lines[2])
        with self.assertRaisesRegex(ValueError, r"manifest\.jsonl:2: is damaged"):
            self.clips()

    def test_the_last_line_of_a_clip_counts(self):
        self.write(self.failed(0), self.lines[1], self.lines[0], self.failed(1), self.lines[2])
        self.assertEqual(self.clips(), [0, 2])

    def test_manifests_of_shards_are_read_together_and_done_wins(self):
        self.write(self.lines[0], self.failed(1), name="manifest.000-of-002.jsonl")
        self.write(self.lines[1], self.failed(0), self.lines[3][:30], name="manifest.001-of-002.jsonl")
        self.assertEqual(self.clips(), [0, 1])
        self.write(self.lines[2], self.failed(0))
        self.assertEqual(self.clips(), [0, 1, 2])

    def test_shards_of_the_program_are_the_set(self):
        from shimmer_dataset import ShimmerDataset
        for layout in ("sequence", "webdataset"):
            whole = self.make(f"{layout}-whole", layout, clips=7)
            for shard in ("0/2", "1/2"):
                parts = self.make(f"{layout}-parts", layout, clips=7, arguments=["--shard", shard])
            self.assertFalse((parts / "manifest.jsonl").exists())
            whole, parts = ShimmerDataset(whole), ShimmerDataset(parts)
            self.assertEqual((len(whole), len(parts)), (21, 21))
            for ours, theirs in zip(whole, parts):
                self.assertEqual([frame.tolist() for frame in ours], [frame.tolist() for frame in theirs])

    def test_a_manifest_that_was_replaced_is_noticed(self):
        from shimmer_dataset import ShimmerDataset
        self.write(*self.lines)
        dataset = ShimmerDataset(self.set)
        for lines in (reversed(self.lines), self.lines[:1], ["[]\n"] * 1000):
            self.write(*lines)
            with self.assertRaisesRegex(ValueError, "clip 3: its line is no longer where it was"):
                dataset[len(dataset) - 1]


class Errors(sets.SetsTest):
    def setUp(self):
        super().setUp()
        self.set = self.make("set", "sequence", frames=2, size=[16, 16], output_truth=["tilt"])

    def assert_error(self, kind, words, **options):
        from shimmer_dataset import ShimmerDataset
        with self.assertRaisesRegex(kind, words):
            list(ShimmerDataset(self.set, **options))

    def test_options_that_cannot_be(self):
        self.assert_error(ValueError, "split = 'val', must be 'train', 'test' or None", split="val")
        self.assert_error(ValueError, "split = 'all'", split="all")
        self.assert_error(ValueError, "frames = 0, must be at least 1, or 'all'", frames=0)
        self.assert_error(ValueError, "frames = 'every'", frames="every")
        self.assert_error(ValueError, "frames = None", frames=None)
        self.assert_error(ValueError, "crop = 0, must be at least 1, or None", crop=0)
        self.assert_error(ValueError, "step = -1", step=-1)
        self.assert_error(ValueError, "its truth has no 'sigma': output.truth is .'tilt'.", truth=["dx", "sigma"])
        self.assert_error(ValueError, "its truth has no 'mask'", truth=["mask"])
        self.assert_error(ValueError, "no clip of it is finished that is in test", split="test")

    def test_indices_outside(self):
        from shimmer_dataset import ShimmerDataset
        for index in (8, -9):
            with self.assertRaises(IndexError):
                ShimmerDataset(self.set)[index]

    def test_folders_without_a_set(self):
        from shimmer_dataset import ShimmerDataset
        (self.set / "manifest.jsonl").rename(self.folder / "away")
        self.assert_error(FileNotFoundError, "holds no manifest.jsonl")
        (self.set / "manifest.jsonl").write_text("")
        self.assert_error(ValueError, "no clip of it is finished")
        with self.assertRaisesRegex(FileNotFoundError, f"{self.folder}: holds no data set"):
            ShimmerDataset(self.folder)

    def test_a_missing_file_is_named_with_its_clip(self):
        (self.set / "clips/000002/turb/0001.png").unlink()
        self.assert_error(FileNotFoundError, "set/clips/000002/turb/0001.png: clip 2: is not there")

    def test_damaged_files_are_named_with_their_clip(self):
        for name in ("turb/0001.png", "clean/0000.png", "truth/0000.exr"):
            path = self.set / "clips/000003" / name
            whole = path.read_bytes()
            for data in (b"", whole[:60], whole[:-len(whole) // 3], b"x" * len(whole)):
                path.write_bytes(data)
                self.assert_error(ValueError, f"{path}: clip 3: ", truth=["dx"])
            path.write_bytes(whole)
        self.assert_error(ValueError, "its truth has no 'dz'", truth=["dz"])

    def test_the_script_tells_what_a_folder_holds(self):
        def run(*arguments):
            done = subprocess.run([sys.executable, "-B", SCRIPT, *arguments], text=True, capture_output=True)
            return done.returncode, done.stdout, done.stderr
        code, printed, _ = run(self.set)
        self.assertEqual(code, 0)
        self.assertRegex(printed, r"^sequence, png of 8 bits\n4 of 4 clips, 0 failed; frames: 8 train, 0 test\n"
                                  r"turb  2 x 3 x 16 x 16, 0\.\d+ to [01]\.\d+\nclean .*\ntruth 2 x 2 x 16 x 16, -")
        error = f"shimmer_dataset.py: {self.folder}: holds no data set (no dataset.json)\n"
        self.assertEqual(run(self.folder), (1, "", error))
        self.assertEqual(run()[0], 1)


if __name__ == "__main__":
    sets.main("cv2", "numpy", "OpenImageIO")
