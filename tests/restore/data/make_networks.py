#!/usr/bin/python3
"""Makes the small networks in this folder, by PyTorch: make_networks.py, in this folder.

fine        a convolution, which OpenCV runs as PyTorch does
normalised  L2-normalises over pixels, which OpenCV 4.6 imports without a word and computes otherwise
sorting     an operator that OpenCV does not have (TopK)
"""

import sys
from pathlib import Path

import torch
from torch import nn
from torch.nn import functional as F

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parents[3] / "scripts/train"))
import export

TILE = 32


class Fine(nn.Module):
    def __init__(self) -> None:
        super().__init__()
        self.mix = nn.Conv2d(3, 3, 3, padding=1, bias=False)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return x + 0.2 * self.mix(x)


class Normalised(Fine):
    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return super().forward(x) + F.normalize(x.reshape(1, 3, -1), dim=-1).reshape(x.shape)


class Sorting(Fine):
    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return super().forward(x) + torch.topk(x, TILE, dim=3)[0]


for network in (Fine, Normalised, Sorting):
    torch.manual_seed(0)
    made = network().eval()
    name = network.__name__.lower()
    kinds = ("onnx", "pt") if network is Fine else ("onnx",)
    for kind in kinds:
        export.export(made, Path(f"{name}.{kind}"), TILE)
        export.beside(made, f"{name}.{kind}", name, TILE, 4)
