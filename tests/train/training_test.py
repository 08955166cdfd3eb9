#!/usr/bin/python3
"""scripts/train, as people call it: small sets of every layout that it reads, small networks, few iterations.

  training_test.py SHIMMER
"""

import csv
import json
import pathlib
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
TRAIN = HERE.parents[1] / "scripts/train"
sys.path[:0] = [str(HERE.parent / "loaders"), str(TRAIN)]

import sets

NETWORK = {"width": 8, "blocks": [1, 1], "heads": [1, 2], "refinement": 1, "unshuffle": 2}


def training(*arguments):
    return subprocess.run([sys.executable, str(TRAIN / "train.py"), *map(str, arguments)], capture_output=True, text=True)


class Training(sets.SetsTest):
    def recipe(self, name="recipe", **keys):
        recipe = {"name": "tiny", "seed": 3, "network": NETWORK, "tile": 64, "overlap": 16,
                  "pairs": [{"dataset": "set"}], "hold_out": 0.25,
                  "stages": [{"iterations": 4, "patch": 16, "batch": 2}, {"iterations": 4, "patch": 32, "batch": 1}],
                  "average": 0.5, "validate": {"every": 4, "count": 2, "patch": 32}, "checkpoint_every": 4, **keys}
        path = self.folder / f"{name}.json"
        path.write_text(json.dumps(recipe))
        return path

    def train(self, recipe, out, *arguments):
        run = training(recipe, "--data", self.folder, "--out", self.folder / out, "--threads", 1, *arguments)
        self.assertEqual(run.returncode, 0, run.stderr)
        return self.folder / out

    def refused(self, *parts, out="run", **keys):
        run = training(self.recipe("bad", **keys), "--data", self.folder, "--out", self.folder / out)
        self.assertEqual(run.returncode, 1)
        self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
        for part in parts:
            self.assertIn(part, run.stderr)

    def tensors(self, out):
        import weights
        return weights.read(out / "tiny.safetensors")

    def assert_same_weights(self, a, b):
        import numpy
        first, second = self.tensors(a)[0], self.tensors(b)[0]
        self.assertEqual(first.keys(), second.keys())
        for name, tensor in first.items():
            numpy.testing.assert_array_equal(tensor, second[name], name)

    def test_reads_sequence_pairs_and_webdataset(self):
        for layout in ("sequence", "pairs", "webdataset"):
            self.make("set", layout, clips=6)
            out = self.train(self.recipe(), f"of_{layout}")
            tensors, card = self.tensors(out)
            self.assertEqual((card["iterations"], card["network"], card["width"]), (8, "restormer", 8))
            self.assertEqual([iteration for iteration, _ in card["curve"]], [4, 8])
            self.assertEqual(len(card["held_out"]), 1)
            self.assertEqual(tensors["sample.input"].shape, (3, 64, 64))
            self.assertTrue((out / "curve.png").read_bytes().startswith(b"\x89PNG"))
            with open(out / "curve.csv") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual([row["iteration"] for row in rows], ["4", "8"])
            for row in rows:
                self.assertGreater(float(row["psnr"]), 10)
                self.assertLessEqual(float(row["ssim"]), 1)
            subprocess.run(["rm", "-r", self.folder / "set"], check=True)

    def test_is_the_same_again_and_taken_up_again(self):
        import torch
        self.make("set", "sequence", clips=6)
        whole = self.train(self.recipe(), "whole", "--workers", 0)
        again = self.train(self.recipe(), "again", "--workers", 2)
        self.assert_same_weights(whole, again)
        # As if it had been killed after the checkpoint of iteration 4.
        import train
        import recipe as recipes
        stopped = self.folder / "stopped"
        stopped.mkdir()
        original = train.Run.step

        class Killed(Exception):
            pass

        def step(run, *batch):
            if run.iteration == 6:
                raise Killed
            return original(run, *batch)

        torch.set_num_threads(1)
        train.Run.step = step
        try:
            with self.assertRaises(Killed):
                train.train(recipes.read(str(self.recipe())), self.folder, stopped, workers=0)
        finally:
            train.Run.step = original
        self.assertFalse((stopped / "tiny.safetensors").exists())
        self.train(self.recipe(), "stopped", "--workers", 1)
        self.assert_same_weights(whole, stopped)
        self.refused("is of another recipe", out="stopped", seed=4)

    def test_gets_better_at_what_it_sees(self):
        """By either loss. A blur that is the same everywhere: 100 iterations gain half a dB, and none would gain nothing."""
        self.make("set", "sequence", clips=6, tilt_strength_px=0, blur_min_sigma_px=1.5, blur_max_sigma_px=1.5)
        import export
        import torch
        from pairs import Pairs
        from validation import psnr
        turb, clean = Pairs(str(self.folder / "set"))[4]
        for loss in ("l1", "psnr"):
            recipe = self.recipe(stages=[{"iterations": 100, "patch": 32, "batch": 4}], hold_out=0, loss=loss,
                                 optimiser={"rate": 3e-3}, validate={"every": 50})
            network, card = export.load(self.train(recipe, loss) / "tiny.safetensors")
            self.assertEqual(card["curve"], [])  # nothing is held out; NaN would be no JSON
            with torch.no_grad():
                sharp = network.whole(torch.from_numpy(turb)[None])[0].numpy()
            self.assertGreater(psnr(sharp, clean), psnr(turb, clean) + 0.5)

    def test_smoke_takes_the_papers_recipe(self):
        self.make("photos", "sequence", clips=3)
        recipe = json.loads((TRAIN / "paper.json").read_text())
        path = self.folder / "paper.json"
        path.write_text(json.dumps({**recipe, "pairs": [{"dataset": "photos"}],
                                    "network": {**recipe["network"], "width": 16}}))
        out = self.train(path, "smoke", "--smoke")
        self.assertTrue((out / f"{recipe['name']}.safetensors").exists())

    def test_recipes_that_ship_are_read(self):
        import recipe
        for path in TRAIN.glob("*.json"):
            self.assertGreater(recipe.iterations(recipe.read(str(path))), 0)

    def test_says_what_is_wrong(self):
        self.make("set", "sequence")
        self.refused("bad.json: unknown key rate;", rate=1)
        self.refused("bad.json: network: width = 9", network={**NETWORK, "width": 9})
        self.refused("bad.json: loss = 'l3', must be one of l1, l2, psnr", loss="l3")
        self.refused("bad.json: a patch or tile of 30 px, must be a multiple of 4",
                     stages=[{"iterations": 1, "patch": 30, "batch": 1}])
        self.refused("bad.json: stages[0] =", stages=[{"iterations": 1, "patch": 32}])
        self.refused("bad.json: overlap = 40, must be less than half of tile = 64", overlap=40)
        self.refused("absent: holds no data set", pairs=[{"dataset": "absent"}])
        self.refused("stacked: is no folder of stacked clips", pairs=[{"dataset": "set", "stacked": "stacked"}])
        self.refused("hold_out = 1: leaves none of the", hold_out=1)


class Stacked(sets.SetsTest):
    def test_pairs_are_of_the_same_clip_and_frame(self):
        """Stacked frames made up of their numbers."""
        import cv2
        import numpy
        from pairs import Pairs
        self.make("set", "sequence", clips=4, frames=3)
        for clip in (1, 3):
            folder = self.folder / "stacked" / f"{clip:06d}"
            folder.mkdir(parents=True)
            for frame in range(3):
                cv2.imwrite(str(folder / f"{frame:04d}.png"), numpy.full((40, 48, 3), 10 * clip + frame, numpy.uint8))
        pairs = Pairs(str(self.folder / "set"), str(self.folder / "stacked"))
        self.assertEqual(len(pairs), 6)
        single = Pairs(str(self.folder / "set"))
        for number, (clip, frame) in enumerate((clip, frame) for clip in (1, 3) for frame in range(3)):
            turb, clean = pairs[number]
            numpy.testing.assert_allclose(turb, (10 * clip + frame) / 255, rtol=1e-6)
            numpy.testing.assert_array_equal(clean, single[3 * clip + frame][1])
            self.assertEqual(pairs.sources[number], single.sources[3 * clip + frame])


    def test_are_what_restoring_makes_without_the_network(self):
        unshimmer = sets.program.with_name("unshimmer")
        self.make("set", "sequence", clips=3)
        stack = [sys.executable, str(TRAIN / "stack.py"), str(self.folder / "set"), "--out", str(self.folder / "stacked"),
                 "--program", str(unshimmer)]
        run = subprocess.run([*stack, "--clips", "2"], capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stdout), (0, "2 clips\n"), run.stderr)
        subprocess.run([unshimmer, "restore", self.folder / "set/clips/000001", "--no-sharpen", "--out",
                        self.folder / "alone", "--quiet"], check=True)
        for frame in range(3):
            name = f"{frame:04d}.png"
            self.assertEqual((self.folder / "stacked/000001" / name).read_bytes(),
                             (self.folder / "alone" / name).read_bytes())
        # Goes on; and a clip that can't be restored is named and left out.
        (self.folder / "stacked/000000/mark").touch()
        broken = self.folder / "set/clips/000002/turb/0001.png"
        broken.write_bytes(broken.read_bytes()[:50])
        run = subprocess.run(stack, capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stdout), (0, "2 clips\n"), run.stderr)
        self.assertIn("clips/000002: unshimmer: ", run.stderr)
        self.assertTrue((self.folder / "stacked/000000/mark").exists())
        self.make("pairs", "pairs")
        run = subprocess.run([*stack[:2], str(self.folder / "pairs"), *stack[3:]], capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.assertIn("output.layout is pairs, must be sequence", run.stderr)


class Draws(sets.SetsTest):
    def test_hold_whole_sources_out_and_depend_on_their_number_alone(self):
        import numpy
        from pairs import Batches, Draws, Pairs, hold_out
        self.make("set", "sequence", clips=8)
        kinds = [Pairs(str(self.folder / "set"))]
        sources = set(kinds[0].sources)
        held_out = hold_out(kinds, 0.25, 5)
        self.assertEqual(len(held_out), max(1, round(0.25 * len(sources))))
        draws = Draws(kinds, [1], held_out, 7)
        self.assertTrue(all(kinds[0].sources[item] not in held_out for item in draws.items[0]))
        for index in ((0, 16), (11, 32), (5, 64)):  # the last is larger than the frames
            first, second = draws[index], draws[index]
            self.assertEqual(tuple(first[0].shape), (3, index[1], index[1]))
            for a, b in zip(first[:2], second[:2]):
                numpy.testing.assert_array_equal(a.numpy(), b.numpy())
        stages = [{"iterations": 3, "patch": 16, "batch": 2}, {"iterations": 2, "patch": 32, "batch": 1}]
        whole = list(Batches(stages, 0))
        self.assertEqual(whole, [[(0, 16), (1, 16)], [(2, 16), (3, 16)], [(4, 16), (5, 16)], [(6, 32)], [(7, 32)]])
        for start in range(6):
            self.assertEqual(list(Batches(stages, start)), whole[start:])


if __name__ == "__main__":
    sets.main("cv2", "torch", "matplotlib")
