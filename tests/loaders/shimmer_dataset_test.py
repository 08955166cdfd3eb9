#!/usr/bin/python3
"""scripts/train/shimmer_dataset.py reads every layout and format: the pixels of the manifest, splits, crops, workers.

  shimmer_dataset_test.py SHIMMER
"""

import json
import pickle
import subprocess
import sys

sys.dont_write_bytecode = True

import sets

sys.path.insert(0, str(sets.REPOSITORY / "scripts/train"))

CHANNELS = ("dx", "dy", "sigma")
FORMATS = (("png", 8, "uint8"), ("png", 16, "uint16"), ("exr", 16, "float16"), ("exr", 32, "float32"))


def samples_of(tensor, dtype):
    """A frame's samples as they are in the file, of a C x H x W tensor that the data set made of them."""
    import numpy
    values = tensor.numpy().transpose(1, 2, 0)
    if numpy.issubdtype(numpy.dtype(dtype), numpy.integer):
        top = numpy.iinfo(dtype).max
        whole = numpy.rint(values * top)
        assert (values == whole.astype(numpy.float32) / numpy.float32(top)).all()
        values = whole
    return numpy.ascontiguousarray(values.astype(dtype))


class Pixels(sets.SetsTest):
    def check_clips(self, folder, dtype, frames, clean_files):
        """Whole clips hold, frame by frame, what the manifest hashes."""
        from shimmer_dataset import ShimmerDataset
        dataset = ShimmerDataset(folder, frames="all", truth=CHANNELS, rgb=False)
        self.assertEqual(len(dataset), 4)
        for index, item in enumerate(dataset):
            line = dataset.line(index)
            self.assertEqual(line, sets.lines_of(folder)[index])
            for kind, frames_of, saved in zip(("turb", "clean", "truth"), item, (dtype, dtype, "float32")):
                files = sets.files_of(line, kind)
                self.assertEqual(len(files), clean_files if kind == "clean" else frames)
                self.assertEqual(str(frames_of.dtype), "torch.float32")
                self.assertEqual(len(frames_of), frames)
                for k, frame in enumerate(frames_of):
                    self.assertEqual(sets.pixel_hash(samples_of(frame, saved)), files[min(k, len(files) - 1)]["pixels"])

    def test_every_layout_and_format(self):
        moving = self.moving_source(3, dtype="uint16")
        for layout in sets.LAYOUTS:
            for number, (form, bits, dtype) in enumerate(FORMATS):
                with self.subTest(layout=layout, format=form, bits=bits):
                    still = number % 2 == 1
                    name = f"{layout}-{form}-{bits}"
                    pairs = layout in ("pairs", "restormer")
                    folder = self.make(name, layout, None if still else moving, output_format=form, output_bits=bits,
                                       output_frames_per_clip=2 if pairs else 1)
                    frames = 2 if pairs else 3
                    alone = still and layout in ("sequence", "webdataset")
                    self.check_clips(folder, dtype, frames, 1 if alone else frames)

    def test_grey_frames_become_three_channels_or_stay_one(self):
        import cv2
        import torch
        from shimmer_dataset import ShimmerDataset
        cv2.imwrite(str(self.folder / "grey.png"), cv2.imread(self.moving_source(1)["sequence"] + "/0000.png", 0))
        for form in ("png", "exr"):
            folder = self.make(form, "sequence", {"images": str(self.folder / "grey.png")}, output_format=form)
            (one, _), (three, _) = (ShimmerDataset(folder, rgb=rgb)[0] for rgb in (False, True))
            self.assertEqual(tuple(one.shape), (1, 40, 48))
            self.assertTrue(torch.equal(three, one.expand(3, -1, -1)))

    def test_windows_of_frames(self):
        import torch
        from shimmer_dataset import ShimmerDataset
        folder = self.make("set", "sequence", self.moving_source(7), frames=7, clips=2)
        clips = [clip for clip, _ in ShimmerDataset(folder, frames="all")]
        for frames, step, starts in ((1, None, range(7)), (1, 4, (0, 4)), (3, None, (0, 3)), (3, 1, range(5)),
                                     (7, None, (0,))):
            dataset = ShimmerDataset(folder, frames=frames, step=step)
            expected = [clip[start:start + frames] for clip in clips for start in starts]
            self.assertEqual(len(dataset), len(expected))
            for (turb, _), window in zip(dataset, expected):
                self.assertTrue(torch.equal(turb, window[0] if frames == 1 else window))
        self.assertTrue(torch.equal(ShimmerDataset(folder)[-2][0], clips[1][5]))
        with self.assertRaisesRegex(ValueError, "clip 0: has fewer than 8 frames"):
            ShimmerDataset(folder, frames=8)


class Items(sets.SetsTest):
    def test_splits_are_disjoint_complete_and_the_same_in_every_layout(self):
        from shimmer_dataset import ShimmerDataset
        found = set()
        for layout in sets.LAYOUTS:
            folder = self.make(layout, layout, clips=11, frames=1, size=[16, 16], output_test_fraction=0.29)
            halves = {}
            for split in ("train", "test", None):
                dataset = ShimmerDataset(folder, split=split)
                halves[split] = [dataset.line(index)["clip"] for index in range(len(dataset))]
                if split and layout in ("pairs", "restormer"):
                    paths = [file["path"] for index in range(len(dataset)) for file in dataset.line(index)["files"]]
                    self.assertEqual({path.split("/")[1] for path in paths}, {split})
            self.assertEqual(halves[None], list(range(11)))
            self.assertEqual(sorted(halves["train"] + halves["test"]), halves[None])
            self.assertEqual(len(halves["test"]), 3)
            found.add(tuple(halves["test"]))
        self.assertEqual(len(found), 1)

    def test_splits_are_those_of_the_program_where_rounding_decides(self):
        from shimmer_dataset import ShimmerDataset
        folder = self.make("set", "pairs", clips=101, frames=1, size=[16, 16], output_truth=[],
                           output_test_fraction=0.29)
        dataset = ShimmerDataset(folder, split="test")  # 100 * 0.29 is 28.999999999999996
        self.assertEqual(len(dataset), len(list((folder / "shimmer/test/turb").iterdir())))
        for index in range(len(dataset)):
            self.assertIn("shimmer/test/", dataset.line(index)["files"][0]["path"])

    def test_a_crop_is_the_same_part_of_turb_clean_and_truth(self):
        import torch
        from shimmer_dataset import ShimmerDataset
        folder = self.make("set", "sequence", self.moving_source(3))
        whole, part = (ShimmerDataset(folder, frames=3, truth=["sigma"], crop=crop) for crop in (None, 24))
        starts = set()
        for index in range(len(whole)):
            places = [[(y, x) for y in range(17) for x in range(25) if torch.equal(full[..., y:y + 24, x:x + 24], cut)]
                      for full, cut in zip(whole[index], part[index])]
            self.assertEqual(len(places[0]), 1)
            self.assertEqual(places[1:], places[:1] * 2)
            starts.add(places[0][0])
        self.assertGreater(len(starts), 1)

    def test_a_crop_larger_than_the_frame_is_reflected(self):
        import numpy
        from shimmer_dataset import ShimmerDataset
        folder = self.make("set", "pairs", size=[20, 9])
        for (full, _), (turb, clean) in zip(ShimmerDataset(folder), ShimmerDataset(folder, crop=64)):
            self.assertEqual(tuple(clean.shape), (3, 64, 64))
            expected = numpy.pad(full.numpy(), ((0, 0), (0, 55), (0, 44)), mode="reflect")
            self.assertTrue((turb.numpy() == expected).all())

    def test_shifts_stay_true_where_items_are_flipped_and_reflected(self):
        import cv2
        import numpy
        from shimmer_dataset import ShimmerDataset
        folder = self.make("set", "sequence", self.moving_source(2, (72, 64), "uint16"), size=[64, 56], frames=2,
                           output_bits=16, blur_max_sigma_px=0, tilt_strength_px=6, tilt_base_frequency=0.01)
        whole, dataset = ShimmerDataset(folder), ShimmerDataset(folder, crop=100, flip=True, truth=("dy", "dx"))
        y, x = numpy.mgrid[:100, :100].astype(numpy.float32)
        flipped = 0
        for index, (turb, clean, (dy, dx)) in enumerate(dataset):
            turb, clean = (frame.numpy().transpose(1, 2, 0) for frame in (turb, clean))
            dy, dx = dy.numpy(), dx.numpy()

            def error(across, down):
                seen = cv2.remap(clean, x + across * dx, y + down * dy, cv2.INTER_CUBIC)
                return numpy.abs(seen - turb)[8:92, 8:92].mean()
            # The waves are smooth, so the right shift explains the frame but for interpolation.
            self.assertLess(10 * error(1, 1), min(error(-1, 1), error(1, -1)))
            flipped += not numpy.array_equal(turb[:56, :64], whole[index][0].numpy().transpose(1, 2, 0))
        self.assertTrue(0 < flipped < len(dataset))

    def test_items_are_functions_of_seed_epoch_and_index(self):
        import torch
        from shimmer_dataset import ShimmerDataset

        def turbs(seed, epoch, order=range(12)):
            dataset = ShimmerDataset(folder, crop=16, flip=True, seed=seed)
            dataset.set_epoch(epoch)
            items = {index: dataset[index][0] for index in order}
            return torch.stack([items[index] for index in range(12)])
        folder = self.make("set", "sequence")
        first = turbs(0, 0)
        self.assertTrue(torch.equal(first, turbs(0, 0, reversed(range(12)))))
        self.assertFalse(torch.equal(first, turbs(0, 1)))
        self.assertFalse(torch.equal(first, turbs(1, 0)))

    def test_a_transform_gets_the_tensors_and_makes_the_item(self):
        from shimmer_dataset import ShimmerDataset
        folder = self.make("set", "sequence")
        dataset = ShimmerDataset(folder, truth=["dx"], transform=lambda turb, clean, truth: tuple(truth.shape))
        self.assertEqual(dataset[0], (1, 40, 48))


class Scenes(sets.SetsTest):
    """Truth of scenes that move, against the files, which this reads by their names and offsets alone."""

    OBJECTS = [{"drawn": "disc", "height_px": 21, "motion": {"start_x": 0.4, "speed_px": 3.5, "direction_deg": 20}}]

    def make_scene(self, layout, **keys):
        single = layout in ("pairs", "restormer")
        truth = ["tilt", "sigma", "mask"] + ([] if single else ["flow", "shake"])
        return self.make(layout, layout, clips=2, objects=self.OBJECTS, camera={"shake": "walk", "bound_px": 9},
                         output_truth=truth, output_frames_per_clip=2 if single else 1, **keys)

    def read(self, folder, file):
        """Bytes of a file, and what OpenImageIO reads of it if it is a picture."""
        import OpenImageIO as oiio
        with open(folder / file["path"], "rb") as opened:
            opened.seek(file.get("offset", 0))
            data = opened.read(file["bytes"])
        name = file.get("member", file["path"])
        if name.endswith(".json"):
            return json.loads(data)
        copy = self.folder / ("copy" + name[-4:])
        copy.write_bytes(data)
        picture = oiio.ImageInput.open(str(copy))
        if name.endswith(".exr"):
            self.assertEqual(set(picture.spec().channelnames) - {"dx", "dy", "sigma"}, {"u", "v"})
        return picture.read_image(picture.spec().format)

    def check_mask(self, folder, line, masks, planes):
        import numpy
        files = sets.files_of(line, "mask")
        self.assertEqual(len(files), len(masks))
        self.assertEqual(masks.dtype, numpy.float32)
        for file, mask, plane in zip(files, masks, planes):
            saved = self.read(folder, file)
            self.assertEqual((str(saved.dtype), saved.shape), ("uint8", (40, 48, 1)))
            self.assertTrue((numpy.rint(255 * mask) == saved[:, :, 0]).all())
            self.assertTrue(0 < (mask == 1).sum() < mask.size / 2 < (mask == 0).sum())
            self.assertTrue((plane == mask).all())

    def check_flow(self, folder, line, flows, planes):
        import numpy
        files = sets.files_of(line, "flow")
        self.assertEqual([flow is None for flow in flows], [False] * len(files) + [True])
        for file, flow, plane in zip(files, flows, planes):
            self.assertTrue((flow == self.read(folder, file)).all())
            self.assertTrue((plane == flow.transpose(2, 0, 1)).all())
            self.assertAlmostEqual(float(numpy.hypot(*flow[flow.any(axis=2)].T).mean()), 3.5, places=4)
        self.assertTrue(numpy.isnan(planes[-1]).all())

    def test_every_layout(self):
        from shimmer_dataset import ShimmerDataset
        for layout in sets.LAYOUTS:
            with self.subTest(layout=layout):
                folder = self.make_scene(layout)
                single = layout in ("pairs", "restormer")
                channels = ("dx", "mask") if single else ("v", "mask", "dx", "u")
                dataset = ShimmerDataset(folder, frames="all", truth=channels)
                for index in range(len(dataset)):
                    line, planes = sets.lines_of(folder)[index], dataset[index][2].numpy()
                    self.check_mask(folder, line, dataset.mask(index), planes[:, 1])
                    if single:
                        self.assertIsNone(dataset.flow(index))
                        self.assertIsNone(dataset.shake(index))
                        continue
                    self.check_flow(folder, line, dataset.flow(index), planes[:, [3, 0]])
                    file, = sets.files_of(line, "shake")
                    self.assertEqual(dataset.shake(index).tolist(), self.read(folder, file)["shifts_px"])
                    self.assertEqual(dataset.shake(index)[0].tolist(), [0, 0])

    def test_single_frames(self):
        import numpy
        from shimmer_dataset import ShimmerDataset
        folder = self.make_scene("sequence")
        whole, single = ShimmerDataset(folder, frames="all"), ShimmerDataset(folder, truth=("u", "mask"))
        for index in range(len(single)):
            clip, frame = divmod(index, 3)
            self.assertTrue((single.mask(index) == whole.mask(clip)[frame]).all())
            self.assertEqual(single.shake(index).tolist(), whole.shake(clip)[frame].tolist())
            flow, there = single.flow(index), whole.flow(clip)[frame]
            self.assertTrue(flow is there is None if frame == 2 else (flow == there).all())
            self.assertEqual(bool(numpy.isnan(single[index][2][0]).all()), frame == 2)

    def test_flipped_items_flow_the_other_way(self):
        import torch
        from shimmer_dataset import ShimmerDataset
        folder = self.make_scene("sequence")
        plain, flipped = (ShimmerDataset(folder, frames=2, step=2, truth=("mask", "u", "v"), flip=flip)
                          for flip in (False, True))
        seen = set()
        for epoch in range(4):
            flipped.set_epoch(epoch)
            for (_, _, ours), (_, _, theirs) in zip(flipped, plain):
                turned = theirs.flip(-1) * torch.tensor([1, -1, 1])[:, None, None]
                seen.add(0 if torch.equal(ours, theirs) else 1 if torch.equal(ours, turned) else 2)
        self.assertEqual(seen, {0, 1})

    def test_what_was_not_written_is_not_there(self):
        from shimmer_dataset import ShimmerDataset
        dataset = ShimmerDataset(self.make("set", "sequence"))
        self.assertEqual([dataset.mask(0), dataset.flow(0), dataset.shake(0)], [None] * 3)
        with self.assertRaisesRegex(ValueError, "its truth has no 'u'"):
            ShimmerDataset(self.folder / "set", truth=("u",))


class Workers(sets.SetsTest):
    def check_workers(self, folder, *ways):
        import torch
        from torch.utils.data import DataLoader
        from shimmer_dataset import ShimmerDataset
        dataset = ShimmerDataset(folder, crop=16, flip=True, truth=CHANNELS)
        plain = {}
        for epoch in (0, 1):
            dataset.set_epoch(epoch)
            plain[epoch] = list(DataLoader(dataset, batch_size=4))  # this process has read files before it forks
        for options in ways:
            loader = DataLoader(dataset, batch_size=4, num_workers=2, timeout=60, **options)
            for epoch in (0, 1):
                dataset.set_epoch(epoch)
                batches = list(loader)
                self.assertEqual(len(batches), 3)
                for batch, expected in zip(batches, plain[epoch]):
                    for ours, theirs in zip(batch, expected):
                        self.assertTrue(torch.equal(ours, theirs))

    def test_workers_give_what_one_process_gives(self):
        self.check_workers(self.make("png", "sequence"), {}, {"multiprocessing_context": "spawn"})
        self.check_workers(self.make("exr", "webdataset", output_format="exr"), {}, {"persistent_workers": True})

    def test_it_can_be_pickled(self):
        import torch
        from shimmer_dataset import ShimmerDataset
        dataset = ShimmerDataset(self.make("set", "sequence"), crop=16, flip=True)
        dataset.set_epoch(3)
        copy = pickle.loads(pickle.dumps(dataset))
        for ours, theirs in zip(dataset, copy):
            self.assertTrue(torch.equal(ours[0], theirs[0]))

    def test_without_torch_items_are_arrays(self):
        folder = self.make("set", "sequence")
        program = ("import sys; sys.modules['torch'] = None; import shimmer_dataset;"
                   "turb, _ = shimmer_dataset.ShimmerDataset(sys.argv[1], crop=16)[0]; print(type(turb), turb.shape)")
        printed = subprocess.run([sys.executable, "-B", "-c", program, folder], cwd=sets.REPOSITORY / "scripts/train",
                                 text=True, check=True, stdout=subprocess.PIPE).stdout
        self.assertEqual(printed, "<class 'numpy.ndarray'> (3, 16, 16)\n")


if __name__ == "__main__":
    sets.main("cv2", "numpy", "OpenImageIO", "torch")
