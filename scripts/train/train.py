#!/usr/bin/python3
"""Trains a Restormer on clips of shimmer and writes its weights for unshimmer.

    train.py RECIPE.json --data FOLDER --out FOLDER [--smoke] [--threads N]

OUT gets checkpoint.pt, curve.csv, curve.png and NAME.safetensors. Run again, it goes on where it stopped.
"""

from __future__ import annotations

import argparse
import copy
import json
import math
import os
import sys
import time
from pathlib import Path
from typing import Any

import torch
from torch.utils.data import DataLoader

import recipe as recipes
import weights
from pairs import Batches, Draws, Pairs, hold_out
from restormer import Restormer, Shape
from sample import record
from validation import Validation, draw_curve


def _share_of_difference(made: torch.Tensor, clean: torch.Tensor, difference: torch.Tensor) -> torch.Tensor:
    """Mean square error over that of the whole frame that it is of, which goes down as the frame's PSNR goes up: every
    frame counts by its dB, and in it a patch by what there is to gain. Frames at 40 dB and more count as at 40 dB."""
    return ((made - clean).square().mean((1, 2, 3)) / difference.clamp(min=1e-4)).mean()


LOSSES = {"l1": lambda made, clean, _: torch.nn.functional.l1_loss(made, clean),
          "l2": lambda made, clean, _: torch.nn.functional.mse_loss(made, clean),
          "psnr": _share_of_difference}


class Run:
    """A network on its way through a recipe, and what is needed to take it up again."""

    def __init__(self, recipe: dict[str, Any], folder: Path) -> None:
        self.recipe, self.folder, self.iteration, self.seconds = recipe, folder, 0, 0.0
        self.device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
        torch.manual_seed(recipe["seed"])
        self.network = Restormer(Shape(**recipe["network"])).to(self.device)
        self.average = copy.deepcopy(self.network)
        rates = recipe["optimiser"]
        self.optimiser = torch.optim.AdamW(self.network.parameters(), lr=rates["rate"],
                                           weight_decay=rates["weight_decay"])

    @property
    def checkpoint(self) -> Path:
        return self.folder / "checkpoint.pt"

    def resume(self) -> None:
        if not self.checkpoint.exists():
            return
        state = torch.load(self.checkpoint, map_location=self.device)
        if state["recipe"] != recipes.fingerprint(self.recipe):
            raise ValueError(f"{self.checkpoint}: is of another recipe: give another --out, or remove it")
        self.network.load_state_dict(state["network"])
        self.average.load_state_dict(state["average"])
        self.optimiser.load_state_dict(state["optimiser"])
        self.iteration, self.seconds = state["iteration"], state["seconds"]

    def save(self) -> None:
        part = self.checkpoint.with_suffix(".part")
        torch.save({"recipe": recipes.fingerprint(self.recipe), "network": self.network.state_dict(),
                    "average": self.average.state_dict(), "optimiser": self.optimiser.state_dict(),
                    "iteration": self.iteration, "seconds": self.seconds}, part)
        os.replace(part, self.checkpoint)

    def step(self, turb: torch.Tensor, clean: torch.Tensor, difference: torch.Tensor) -> float:
        rates = self.recipe["optimiser"]
        done = self.iteration / recipes.iterations(self.recipe)
        for group in self.optimiser.param_groups:
            group["lr"] = rates["last_rate"] + (rates["rate"] - rates["last_rate"]) * (1 + math.cos(math.pi * done)) / 2
        turb, clean, difference = (tensor.to(self.device) for tensor in (turb, clean, difference))
        loss = LOSSES[self.recipe["loss"]](self.network(turb), clean, difference)
        if not torch.isfinite(loss):
            raise FloatingPointError(f"iteration {self.iteration}: the loss is {loss.item()}; the last whole state is "
                                     f"{self.checkpoint}")
        self.optimiser.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), 1.0)
        self.optimiser.step()
        self.iteration += 1
        # A young average would remember the first weights: it grows old with the run.
        decay = min(self.recipe["average"], self.iteration / (self.iteration + 10))
        with torch.no_grad():
            for mean, now in zip(self.average.parameters(), self.network.parameters()):
                mean.lerp_(now, 1 - decay)
        return loss.item()

    def export(self, curve: list[dict[str, str]], held_out: set[str], data: Path) -> Path:
        """Weights as float16, with what the network rounded so makes of a sample, and the model card."""
        network = copy.deepcopy(self.average).cpu().eval()
        tensors = {name: value.half().numpy() for name, value in network.state_dict().items()}
        with torch.no_grad():
            for value in network.state_dict().values():
                value.copy_(value.half().float())
        path = self.folder / f"{self.recipe['name']}.safetensors"
        weights.write(path, {**tensors, **record(network)}, card_of(self.recipe, self.iteration, curve, held_out, data))
        return path


def card_of(recipe: dict[str, Any], iteration: int, curve: list[dict[str, str]], held_out: set[str],
            data: Path) -> dict[str, Any]:
    """The model card: how the network is built, and how it came to be."""
    shape = Shape(**recipe["network"])
    sets = {}
    for name in dict.fromkeys(entry["dataset"] for entry in recipe["pairs"]):
        dataset = json.loads((data / name / "dataset.json").read_text())
        sets[name] = {"config": dataset["config"], "engine": dataset["engine"]}
    return {"format": 1, "name": recipe["name"], **shape.card(), "tile": recipe["tile"], "overlap": recipe["overlap"],
            "seed": recipe["seed"], "iterations": iteration, "recipe": recipe, "data": sets,
            "held_out": sorted(held_out),
            "curve": [[int(row["iteration"]), float(row["psnr"])] for row in curve if math.isfinite(float(row["psnr"]))]}


def train(recipe: dict[str, Any], data: Path, folder: Path, workers: int) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    kinds = [Pairs(str(data / entry["dataset"]), entry.get("stacked") and str(data / entry["stacked"]))
             for entry in recipe["pairs"]]
    held_out = hold_out(kinds, recipe["hold_out"], recipe["seed"])
    run = Run(recipe, folder)
    run.resume()
    draws = Draws(kinds, [entry.get("weight", 1) for entry in recipe["pairs"]], held_out, recipe["seed"])
    loader = DataLoader(draws, batch_sampler=Batches(recipe["stages"], run.iteration), num_workers=workers)
    validation = Validation(kinds, held_out, recipe["validate"], folder / "curve.csv", run.iteration)
    last, total = time.monotonic(), recipes.iterations(recipe)
    losses: list[float] = []
    for batch in loader:
        losses.append(run.step(*batch))
        now = time.monotonic()
        run.seconds, last = run.seconds + now - last, now
        if run.iteration % recipe["validate"]["every"] == 0 or run.iteration == total:
            row = validation.add(run.iteration, run.seconds, sum(losses) / len(losses), run.average, run.device)
            print(f"{run.iteration} of {total}: loss {row['loss']}, validation {row['psnr']} dB "
                  f"(input {row['input_psnr']}), SSIM {row['ssim']} ({row['input_ssim']}), {row['seconds']} s", flush=True)
            losses = []
            last = time.monotonic()
        if run.iteration % recipe["checkpoint_every"] == 0 or run.iteration == total:
            run.save()
    draw_curve(validation.rows, folder / "curve.png")
    return run.export(validation.rows, held_out, data)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipe")
    parser.add_argument("--data", type=Path, default=Path("."), help="the folder that the recipe's paths begin in")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--smoke", action="store_true", help="twenty small iterations, to see that everything runs")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--workers", type=int, default=1, help="processes that read")
    arguments = parser.parse_args()
    torch.set_num_threads(arguments.threads)
    try:
        recipe = recipes.read(arguments.recipe)
        recipe = recipes.smoke(recipe) if arguments.smoke else recipe
        print(train(recipe, arguments.data, arguments.out, arguments.workers))
    except (OSError, ValueError, FloatingPointError) as error:
        sys.exit(f"train.py: {error}")
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
