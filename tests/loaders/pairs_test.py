#!/usr/bin/python3
"""Layout pairs, read by the rules of the paper authors' training code (Riponcs/Turb-Seg-Res, TrainRestormer/utils.py).

Their TurbDataset takes DATA_PATH/DATA_NAME/{train,test}/{turb,noturb}/*.png and *.jpg, sorts each list, and pairs the
n-th of one with the n-th of the other, whatever their names. It reflects small frames at both sides by what they lack,
which needs more than half of the patch.

  pairs_test.py SHIMMER
"""

import glob
import json
import sys

sys.dont_write_bytecode = True

import sets

# What its --data_name takes, and the largest of its --patch_size.
NAMES = ("rain100L", "rain100H", "TurbRain", "testTurb", "ASU_Turbulence_Clean_100k_dataset_v1", "MeanDistorted",
         "Middle", "MeanDistBlur")
LARGEST_PATCH = 384


def turb_dataset(data_path, data_name, half):
    """Its two lists of paths, turb and noturb."""
    return [sorted(path for extension in ("png", "jpg")
                   for path in glob.glob(f"{data_path}/{data_name}/{half}/{kind}/*.{extension}"))
            for kind in ("turb", "noturb")]


class Pairs(sets.SetsTest):
    def test_sorted_lists_pair_the_frames_of_the_manifest(self):
        import cv2
        folder = self.make("set", "pairs", clips=8, output_name=NAMES[4], output_test_fraction=0.25,
                           output_frames_per_clip=2)
        read = {}
        for half, count in (("train", 12), ("test", 4)):
            turb, noturb = turb_dataset(folder, NAMES[4], half)
            self.assertEqual((len(turb), len(noturb)), (count, count))
            for paths in zip(turb, noturb):
                frames = [cv2.imread(path, cv2.IMREAD_COLOR)[:, :, ::-1] for path in paths]
                read[str(paths[0])] = tuple(sets.pixel_hash(frame) for frame in frames)
        written = {}
        for line in sets.lines_of(folder).values():
            for turb, clean in zip(sets.files_of(line, "turb"), sets.files_of(line, "clean")):
                written[str(folder / turb["path"])] = (turb["pixels"], clean["pixels"])
        self.assertEqual(read, written)

    def test_nothing_else_lies_between_the_pictures(self):
        folder = self.make("set", "pairs", output_test_fraction=0.5)
        for half in ("train", "test"):
            for kind in ("turb", "noturb"):
                names = [path.name for path in (folder / "shimmer" / half / kind).iterdir()]
                self.assertEqual(len(names), 2)
                for name in names:
                    self.assertRegex(name, r"^\d{6}\.png$")

    def test_a_network_learns_from_them(self):
        """Twenty iterations of their loop: patches cut from pairs by their lists, L1, AdamW; the loss falls."""
        try:
            import torch
        except ImportError:
            self.skipTest("needs torch (scripts/setup.sh --training)")
        import cv2
        sys.path.insert(0, str(sets.REPOSITORY / "scripts/train"))
        from restormer import Restormer, Shape
        folder = self.make("set", "pairs", clips=8, tilt_strength_px=0, blur_min_sigma_px=1.5, blur_max_sigma_px=1.5)
        lists = turb_dataset(folder, "shimmer", "train")
        pairs = [[torch.from_numpy(cv2.imread(path, cv2.IMREAD_COLOR)[:, :, ::-1].copy()).permute(2, 0, 1) / 255
                  for path in paths] for paths in zip(*lists)]
        torch.manual_seed(1)
        torch.set_num_threads(1)
        network = Restormer(Shape(width=8, blocks=(1, 1), heads=(1, 2), refinement=0))
        optimiser = torch.optim.AdamW(network.parameters(), lr=3e-3, weight_decay=1e-4)
        losses = []
        for iteration in range(20):
            cut = [(int(torch.randint(8, ())), int(torch.randint(16, ()))) for _ in range(4)]
            turb, clean = (torch.stack([pairs[(4 * iteration + k) % len(pairs)][kind][:, y:y + 32, x:x + 32]
                                        for k, (y, x) in enumerate(cut)]) for kind in (0, 1))
            loss = torch.nn.functional.l1_loss(network(turb), clean)
            optimiser.zero_grad()
            loss.backward()
            optimiser.step()
            losses.append((loss / torch.nn.functional.l1_loss(turb, clean)).item())
        self.assertAlmostEqual(losses[0], 1, places=5)  # it begins as one that changes nothing
        self.assertLess(sum(losses[-5:]) / 5, 0.97)

    def test_our_config_for_it_has_a_name_and_a_size_that_it_takes(self):
        config = json.loads((sets.REPOSITORY / "configs/train_pairs.json").read_text())
        self.assertIn(config["output"]["name"], NAMES)
        self.assertGreater(2 * min(config["size"]), LARGEST_PATCH)


if __name__ == "__main__":
    sets.main("cv2")
