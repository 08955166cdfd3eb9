#!/usr/bin/python3
"""Tiny networks as TorchScript, whose flow is known: networks.py FOLDER writes NAME.pt of each.

All take two images Nx3xHxW and give flow Nx2xHxW, or what is said below.
"""

import pathlib
import sys

import torch
from torch import Tensor, nn


def flow_of(x, y):
    return torch.cat([x, y], dim=1)


class Constant(nn.Module):
    """3 px right and 2 px up, everywhere."""

    def forward(self, a, b):
        return flow_of(0 * a[:, :1] + 3, 0 * a[:, :1] - 2)


class Samples(nn.Module):
    """x: the first image's red; y: the second's green plus a hundredth of its blue."""

    def forward(self, a, b):
        return flow_of(a[:, :1], b[:, 1:2] + b[:, 2:3] / 100)


class Place(nn.Module):
    """The column and the row of each pixel."""

    def forward(self, a: Tensor, b: Tensor) -> Tensor:
        columns, rows = torch.arange(a.shape[3]), torch.arange(a.shape[2])
        return flow_of(0 * a[:, :1] + columns, 0 * a[:, :1] + rows[:, None])


class Corners(nn.Module):
    """The first image's red at the top left, and the second's at the bottom right, everywhere."""

    def forward(self, a: Tensor, b: Tensor) -> Tensor:
        return flow_of(0 * a[:, :1] + a[0, 0, 0, 0], 0 * a[:, :1] + b[0, 0, -1, -1])


class Pyramid(nn.Module):
    """Its flow at an eighth of the size, and at the size."""

    def forward(self, a, b):
        fine = flow_of(a[:, :1], b[:, :1])
        return nn.functional.avg_pool2d(fine, 8), fine


class Steps(nn.Module):
    """Flows that become finer, as a list."""

    def forward(self, a: Tensor, b: Tensor) -> list[Tensor]:
        return [0 * flow_of(a[:, :1], a[:, :1]), flow_of(a[:, :1], b[:, :1])]


class Bright(nn.Module):
    """9 px where the first image is brighter than 150 of 255, else 0."""

    def forward(self, a, b):
        return flow_of(9.0 * (a[:, :1] > 150), 0 * a[:, :1])


class Layers(nn.Module):
    """Convolutions of random weights, and what drops their results at random while a network is trained."""

    def __init__(self):
        super().__init__()
        torch.manual_seed(1)
        self.layers = nn.Sequential(nn.Conv2d(6, 32, 3, padding=1), nn.InstanceNorm2d(32), nn.ReLU(), nn.Dropout(),
                                    nn.Conv2d(32, 2, 3, padding=1))

    def forward(self, a, b):
        return self.layers(torch.cat([a, b], dim=1) / 255)


class FourChannels(nn.Module):
    def forward(self, a, b):
        return torch.cat([a, b[:, :1]], dim=1)


class NotFinite(nn.Module):
    def forward(self, a, b):
        return flow_of(a[:, :1], b[:, :1] / 0)


class Half(nn.Module):
    """At half the size."""

    def forward(self, a, b):
        return nn.functional.avg_pool2d(flow_of(a[:, :1], b[:, :1]), 2)


class Nothing(nn.Module):
    def forward(self, a: Tensor, b: Tensor) -> list[Tensor]:
        return []


class OneImage(nn.Module):
    def forward(self, a):
        return a[:, :2]


class Wide(nn.Module):
    """Says that something is wrong with images wider than 200 px."""

    def forward(self, a: Tensor, b: Tensor) -> Tensor:
        if a.shape[3] > 200:
            raise ValueError("too wide for me")
        return flow_of(a[:, :1], b[:, :1])


class Talking(nn.Module):
    def forward(self, a: Tensor, b: Tensor) -> Tensor:
        print("heard by nobody")
        return flow_of(a[:, :1], b[:, :1])


def save(folder, name, network, range=None):
    network.save(str(folder / f"{name}.pt"), _extra_files={} if range is None else {"range": range})


def main(folder):
    images = torch.zeros(1, 3, 16, 24), torch.zeros(1, 3, 16, 24)
    for network in [Constant, Samples, Pyramid, Bright, FourChannels, NotFinite, Half]:
        save(folder, network.__name__, torch.jit.trace(network(), images, check_trace=False))
    for network in [Place, Corners, Layers, Steps, Nothing, OneImage, Wide, Talking]:
        save(folder, network.__name__, torch.jit.script(network()))
    samples = torch.jit.script(Samples())
    for name, range in [("Signed", "-1 1"), ("Backwards", "1 -1"), ("OneNumber", "255"), ("Words", "0 255 px")]:
        save(folder, name, samples, range)
    torch.save(Layers().state_dict(), folder / "Weights.pt")
    whole = (folder / "Layers.pt").read_bytes()
    (folder / "Cut.pt").write_bytes(whole[: len(whole) // 2])
    (folder / "Text.pt").write_text("no network")
    (folder / "Empty.pt").write_bytes(b"")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
