#!/usr/bin/python3
"""Layout restormer, read by the rules of Restormer's training code (swz30/Restormer, basicsr/).

Dataset_PairedImage takes the names of meta_info_file (a line up to its first space) in dataroot_gt, and the same names
in dataroot_lq; without that file, what lies in both folders, whose counts and names must agree. It decodes each file by
OpenCV to 3 channels of 8 bits. train.py cuts patches of gt_size and then gt_sizes[i] out of them.

  restormer_test.py SHIMMER
"""

import os
import sys

sys.dont_write_bytecode = True

import sets


def paired_paths(options, root):
    """Dataset_PairedImage's (lq, gt) paths, seen from the folder root."""
    lq_root, gt_root = root / options["dataroot_lq"], root / options["dataroot_gt"]
    if options.get("meta_info_file"):
        names = [line.split(" ")[0] for line in (root / options["meta_info_file"]).read_text().splitlines()]
    else:
        names = os.listdir(gt_root)
        assert len(os.listdir(lq_root)) == len(names)
        assert set(os.listdir(lq_root)) == set(names)
    template = options.get("filename_tmpl", "{}")
    return [(lq_root / (template.format(stem) + extension), gt_root / name)
            for name in names for stem, extension in [os.path.splitext(os.path.basename(name))]]


def options_of(folder, name="shimmer"):
    import yaml
    return yaml.safe_load((folder / name / "restormer.yml").read_text())


class Restormer(sets.SetsTest):
    def check_pairs(self, folder, options):
        """What the loader reads are the frames that the manifest names, each once. Returns the number of pairs."""
        import cv2
        hashes = {}
        for line in sets.lines_of(folder).values():
            for lq, gt in zip(sets.files_of(line, "turb"), sets.files_of(line, "clean")):
                hashes[folder / lq["path"]] = (lq["pixels"], gt["pixels"])
        pairs = [pair for half in options["datasets"].values() for pair in paired_paths(half, folder)]
        self.assertEqual(sorted(lq for lq, _ in pairs), sorted(hashes))
        for lq, gt in pairs:
            frames = [cv2.imread(str(path), cv2.IMREAD_COLOR)[:, :, ::-1] for path in (lq, gt)]
            self.assertEqual(tuple(map(sets.pixel_hash, frames)), hashes[lq])
        return len(pairs)

    def test_both_halves_load_by_their_meta_files(self):
        folder = self.make("set", "restormer", clips=8, output_test_fraction=0.25, output_frames_per_clip=2)
        options = options_of(folder)
        self.assertEqual(self.check_pairs(folder, options), 16)
        self.assertEqual([len(paired_paths(options["datasets"][half], folder)) for half in ("train", "val")], [12, 4])

    def test_both_halves_load_by_their_folders(self):
        folder = self.make("set", "restormer", clips=8, output_test_fraction=0.25)
        options = options_of(folder)
        for half in options["datasets"].values():
            del half["meta_info_file"]
        self.assertEqual(self.check_pairs(folder, options), 8)

    def test_meta_lines_tell_the_shape(self):
        folder = self.make("set", "restormer")
        lines = (folder / "shimmer/train/meta_info.txt").read_text().splitlines()
        self.assertEqual(lines, [f"{clip:06}.png (40,48,3)" for clip in range(4)])

    def test_a_strange_name_is_quoted(self):
        name = 'hot "air": 30° #1'
        folder = self.make("set", "restormer", output_name=name, output_test_fraction=0.5)
        options = options_of(folder, name)
        self.assertEqual(options["name"], f"Restormer_{name}")
        self.assertEqual(self.check_pairs(folder, options), 4)

    def test_without_test_clips_there_is_no_validation(self):
        options = options_of(self.make("set", "restormer", output_test_fraction=0))
        self.assertEqual(list(options["datasets"]), ["train"])
        self.assertIsNone(options.get("val"))

    def test_exr_has_no_options_for_it_cannot_be_read(self):
        folder = self.make("set", "restormer", output_format="exr")
        self.assertTrue((folder / "shimmer/train/lq/000000.exr").exists())
        self.assertFalse((folder / "shimmer/restormer.yml").exists())

    def test_options_are_what_train_py_reads(self):
        options = options_of(self.make("set", "restormer", output_test_fraction=0.5))
        self.assertLessEqual({"name", "model_type", "scale", "num_gpu", "manual_seed", "datasets", "network_g", "path",
                              "train", "val", "logger", "dist_params"}, set(options))
        train = options["datasets"]["train"]
        self.assertLessEqual({"name", "type", "dataroot_gt", "dataroot_lq", "geometric_augs", "filename_tmpl",
                              "io_backend", "use_shuffle", "num_worker_per_gpu", "batch_size_per_gpu",
                              "mini_batch_sizes", "iters", "gt_size", "gt_sizes", "dataset_enlarge_ratio",
                              "prefetch_mode"}, set(train))
        self.assertEqual((options["model_type"], options["scale"]), ("ImageCleanModel", 1))
        self.assertEqual(train["type"], "Dataset_PairedImage")
        self.assertEqual(options["network_g"]["type"], "Restormer")
        self.assertEqual(train["io_backend"], {"type": "disk"})
        self.assertNotIn("debug", options["name"])  # train.py takes that for a trial and stops to save
        # What a loop over iterations indexes or sums must fit.
        stages = len(train["gt_sizes"])
        self.assertEqual((len(train["iters"]), len(train["mini_batch_sizes"])), (stages, stages))
        self.assertEqual(sum(train["iters"]), options["train"]["total_iter"])
        self.assertEqual(max(train["gt_sizes"]), train["gt_size"])
        self.assertEqual(max(train["mini_batch_sizes"]), train["batch_size_per_gpu"])
        scheduler = options["train"]["scheduler"]
        self.assertEqual(sum(scheduler["periods"]), options["train"]["total_iter"])
        # PyYAML takes 3e-4 without a dot for a text, which the optimiser then refuses.
        optimiser = options["train"]["optim_g"]
        for value in (optimiser["lr"], optimiser["weight_decay"], *scheduler["eta_mins"]):
            self.assertIsInstance(value, float)

    def test_patches_fit_the_frames_and_the_network(self):
        for size, expected in (([400, 500], [128, 160, 192, 256, 320, 384]), ([100, 200], [96] * 6), ([5, 9], [8] * 6),
                               ([256, 300], [128, 160, 192, 256, 256, 256])):
            options = options_of(self.make(f"{size[0]}", "restormer", clips=1, frames=1, size=size))
            self.assertEqual(options["datasets"]["train"]["gt_sizes"], expected)


if __name__ == "__main__":
    sets.main("cv2", "yaml")
