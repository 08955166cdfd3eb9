"""What training takes: pairs of a turbulent or a stacked frame and its clean one, cut at random.

Sources of pairs are data sets of shimmer, of any layout, and for stacked frames the folder that stack.py made of one.
Whole sources (photographs) are held out for validation.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Mapping, Sequence

import cv2
import numpy as np
import torch
from torch.utils.data import Dataset

from shimmer_dataset import ShimmerDataset

LEAST_HELD_OUT = 1  # source


class Pairs:
    """Items are (input, clean), each 3 x H x W float32 in [0, 1], of whole frames."""

    def __init__(self, dataset: str, stacked: str | None = None) -> None:
        self.frames = ShimmerDataset(dataset)
        self.stacked = Path(stacked) if stacked else None
        self.items = range(len(self.frames))
        if self.stacked:
            if not self.stacked.is_dir():
                raise FileNotFoundError(f"{stacked}: is no folder of stacked clips: make it with stack.py")
            there = {int(folder.name) for folder in self.stacked.iterdir() if folder.name.isdigit()}
            self.items = [item for item in self.items if self.frames.place(item)[0] in there]
            if not self.items:
                raise ValueError(f"{stacked}: has no clip of {dataset}")
        names: dict[int, str] = {}  # of each clip
        for item in self.items:
            clip = self.frames.place(item)[0]
            names[clip] = names.get(clip) or self.frames.source(item)
        self.sources = [names[self.frames.place(item)[0]] for item in self.items]

    def __len__(self) -> int:
        return len(self.items)

    def __getitem__(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        item = self.items[index]
        turb, clean = (np.asarray(frame) for frame in self.frames[item])
        if self.stacked:
            clip, frame = self.frames.place(item)
            turb = _read(self.stacked / f"{clip:06d}" / f"{frame:04d}.png")
            if turb.shape != clean.shape:
                raise ValueError(f"{self.stacked}: clip {clip}: frame {frame} is {turb.shape}, "
                                 f"its clean one {clean.shape}")
        return turb, clean


def _read(path: Path) -> np.ndarray:
    frame = cv2.imread(str(path), cv2.IMREAD_COLOR | cv2.IMREAD_ANYDEPTH)
    if frame is None:
        raise ValueError(f"{path}: is not there or no whole picture")
    white = np.float32(np.iinfo(frame.dtype).max)
    return frame[:, :, ::-1].transpose(2, 0, 1).astype(np.float32) / white


def hold_out(kinds: Sequence[Pairs], share: float, seed: int) -> set[str]:
    """The sources that validation gets: so large a share of all, drawn by the seed, whole ones."""
    sources = sorted({source for pairs in kinds for source in pairs.sources})
    if share <= 0:
        return set()
    count = max(LEAST_HELD_OUT, round(share * len(sources)))
    if count >= len(sources):
        raise ValueError(f"hold_out = {share}: leaves none of the {len(sources)} sources to train on")
    return set(np.random.default_rng(seed).permutation(sources)[:count].tolist())


class Draws(Dataset):
    """Training samples by number: what sample n is depends on (seed, n) alone, not on workers or where a run resumed.

    An index is (n, patch): the sample's number and the side of its square, px. Frames that are smaller are reflected.
    A sample is (input, clean, mean square difference of the whole frames).
    """

    def __init__(self, kinds: Sequence[Pairs], weights: Sequence[float], held_out: set[str], seed: int) -> None:
        self.kinds, self.seed = kinds, seed
        self.items = [[n for n, source in enumerate(pairs.sources) if source not in held_out] for pairs in kinds]
        for pairs, items in zip(kinds, self.items):
            if not items:
                raise ValueError(f"{pairs.frames.folder}: all of its sources are held out, none is left to train on")
        self.weights = np.array(weights, np.float64) / np.sum(weights)

    def __getitem__(self, index: tuple[int, int]) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        number, patch = index
        rng = np.random.default_rng((self.seed, number))
        kind = int(rng.choice(len(self.kinds), p=self.weights))
        turb, clean = self.kinds[kind][self.items[kind][int(rng.integers(len(self.items[kind])))]]
        height, width = turb.shape[1:]
        y, x = (int(rng.integers(max(side - patch, 0) + 1)) for side in (height, width))
        turned = rng.random(3) < 0.5  # left to right, top to bottom, and over the diagonal
        difference = torch.tensor(np.mean((turb - clean) ** 2))
        return *(torch.from_numpy(_cut(frame, y, x, patch, turned)) for frame in (turb, clean)), difference


def _cut(frame: np.ndarray, y: int, x: int, patch: int, turned: np.ndarray) -> np.ndarray:
    part = frame[:, y:y + patch, x:x + patch]
    lack = [(0, patch - side) for side in part.shape[1:]]
    part = np.pad(part, [(0, 0), *lack], mode="reflect")
    part = part[:, :, ::-1] if turned[0] else part
    part = part[:, ::-1] if turned[1] else part
    part = part.transpose(0, 2, 1) if turned[2] else part
    return np.ascontiguousarray(part)


class Batches:
    """The indices of Draws, a list a batch, from iteration `start` on: patches and batches grow by stage."""

    def __init__(self, stages: Sequence[Mapping[str, Any]], start: int) -> None:
        self.stages, self.start = stages, start

    def __iter__(self):
        first, before = 0, 0  # sample number, iteration
        for stage in self.stages:
            for iteration in range(before, before + stage["iterations"]):
                if iteration >= self.start:
                    yield [(first + k, stage["patch"]) for k in range(stage["batch"])]
                first += stage["batch"]
            before += stage["iterations"]

    def __len__(self) -> int:
        return sum(stage["iterations"] for stage in self.stages) - self.start
