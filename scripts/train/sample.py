"""What a network makes of a small picture, recorded beside its weights: unshimmer checks it before it uses them."""

from __future__ import annotations

import numpy as np
import torch
from torch import nn

SIDE = 64  # px


def picture(side: int = SIDE) -> torch.Tensor:
    """1 x 3 x side x side in [0, 1]: smooth, as pictures are, with an edge, and the same everywhere."""
    y, x = torch.meshgrid(torch.arange(side), torch.arange(side), indexing="ij")
    waves = [0.5 + 0.3 * torch.sin(x / (5 + channel) + y / (11 - 2 * channel)) for channel in range(3)]
    return (torch.stack(waves) + 0.2 * (x > side // 2)).clamp(0, 1)[None].float()


def record(network: nn.Module, side: int = SIDE) -> dict[str, np.ndarray]:
    """Tensors sample.input and sample.output, 3 x side x side."""
    with torch.no_grad():
        image = picture(side)
        return {"sample.input": image[0].numpy(), "sample.output": network(image)[0].numpy()}
