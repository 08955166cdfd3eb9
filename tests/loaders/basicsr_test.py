#!/usr/bin/python3
"""Layout basicsr, read by the rules of BasicSR's REDS loader (XPixelGroup/BasicSR, basicsr/data/reds_dataset.py).

REDSDataset takes each line of meta_info_file, FOLDER COUNT SHAPE with single spaces between, as the keys
FOLDER/00000000 ... of COUNT frames; drops the folders of its validation partition; and reads num_frame frames around
each key from dataroot_lq and the one in the middle from dataroot_gt, as FOLDER/%08d.png, clamped to frames 0 .. 99.

  basicsr_test.py SHIMMER
"""

import random
import sys

sys.dont_write_bytecode = True

import sets

PARTITIONS = {"REDS4": ["000", "011", "015", "020"], "official": [f"{clip:03}" for clip in range(240, 270)]}


class RedsDataset:
    """Its rules, over the folder that has gt/, lq/ and meta_info.txt."""

    def __init__(self, root, val_partition="REDS4", num_frame=5, interval=1):
        assert num_frame % 2 == 1
        self.root, self.half, self.interval = root, num_frame // 2, interval
        self.keys = []
        for line in (root / "meta_info.txt").read_text().splitlines():
            folder, count, _ = line.split(" ")
            self.keys += [(folder, frame) for frame in range(int(count))]
        self.keys = [key for key in self.keys if key[0] not in PARTITIONS[val_partition]]

    def window(self, folder, middle):
        """The paths of the lq frames, and that of the gt frame."""
        reach = self.half * self.interval
        while middle - reach < 0 or middle + reach > 99:
            middle = random.randint(0, 99)
        frames = range(middle - reach, middle + reach + 1, self.interval)
        lq = [self.root / "lq" / folder / f"{frame:08}.png" for frame in frames]
        return lq, self.root / "gt" / folder / f"{middle:08}.png"


class BasicSR(sets.SetsTest):
    def setUp(self):
        super().setUp()
        random.seed(1)

    def check_windows(self, dataset, part, line):
        """Every key of the clip gives 5 frames, and the gt in their middle, that are those of the manifest."""
        import cv2
        hashes = {part / file["path"]: file["pixels"] for file in line["files"] if file["path"].endswith(".png")}
        folder = f"{line['clip'] % 1000:03}"
        keys = [key for key in dataset.keys if key[0] == folder]
        self.assertEqual(len(keys), 100)
        for _, middle in keys[::7] + keys[:3] + keys[-3:]:
            lq, gt = dataset.window(folder, middle)
            self.assertEqual(len(lq), 5)
            for path in [*lq, gt]:
                frame = cv2.imread(str(path), cv2.IMREAD_COLOR)
                self.assertEqual(sets.pixel_hash(frame[:, :, ::-1]), hashes[path], path)

    def test_windows_of_moving_clips_load(self):
        folder = self.make("set", "basicsr", self.moving_source(100), clips=2, frames=100, size=[24, 16],
                           output_truth=[])
        dataset = RedsDataset(folder)
        self.assertEqual({folder for folder, _ in dataset.keys}, {"001"})  # 000 is REDS4's
        self.check_windows(dataset, folder, sets.lines_of(folder)[1])
        dataset = RedsDataset(folder, "official")
        self.assertEqual({folder for folder, _ in dataset.keys}, {"000", "001"})
        self.check_windows(dataset, folder, sets.lines_of(folder)[0])

    def test_a_still_clip_has_a_gt_for_every_frame(self):
        folder = self.make("set", "basicsr", clips=2, frames=100, size=[24, 16])
        line = sets.lines_of(folder)[1]
        self.check_windows(RedsDataset(folder), folder, line)
        self.assertEqual([len(sets.files_of(line, kind)) for kind in ("turb", "clean", "truth")], [100, 100, 100])

    def test_meta_lines_have_three_words(self):
        folder = self.make("set", "basicsr", clips=3, frames=2, size=[24, 16])
        meta = (folder / "meta_info.txt").read_text()
        self.assertEqual(meta, "000 2 (16,24,3)\n001 2 (16,24,3)\n002 2 (16,24,3)\n")

    def test_clips_from_1000_on_are_a_set_of_their_own(self):
        keys = {"clips": 1003, "frames": 100, "size": [16, 16], "output_truth": []}
        self.make("set", "basicsr", arguments=["--clip", "1"], **keys)
        folder = self.make("set", "basicsr", arguments=["--clip", "1002"], **keys)
        lines = sets.lines_of(folder)
        self.assertEqual(sorted(lines), [1, 1002])
        self.check_windows(RedsDataset(folder), folder, lines[1])
        self.assertEqual({folder for folder, _ in RedsDataset(folder).keys}, {"001"})
        part = RedsDataset(folder / "part001")
        self.assertEqual({folder for folder, _ in part.keys}, {"002"})
        self.check_windows(part, folder, lines[1002])


if __name__ == "__main__":
    sets.main("cv2")
