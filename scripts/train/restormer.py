"""Restormer (Zamir et al., CVPR 2022) as Shimmer trains it: any width, depth and number of levels.

The names of its parameters are those of the files that unshimmer reads (docs/formats.md, "Weights"). With unshuffle 2 or 4
the network works at a half or a quarter of the size: its input's pixels of 2x2 or 4x4 become channels.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import torch
from torch import nn
from torch.nn import functional as F


@dataclass(frozen=True)
class Shape:
    """What a network is built by. Level l has width * 2^l channels at 2^-l of the size; the last level is the bottom."""

    width: int = 48
    blocks: tuple[int, ...] = (4, 6, 6, 8)  # transformer blocks a level, in the encoder and again in the decoder
    heads: tuple[int, ...] = (1, 2, 4, 8)
    refinement: int = 4                     # further blocks after the decoder
    expansion: float = 2.66                 # hidden channels of a feed-forward part, as a factor
    norm: str = "with_bias"                 # or "bias_free"
    unshuffle: int = 1                      # px along a side that become channels at the input

    def __post_init__(self) -> None:
        object.__setattr__(self, "blocks", tuple(self.blocks))
        object.__setattr__(self, "heads", tuple(self.heads))
        if len(self.blocks) != len(self.heads) or len(self.blocks) < 2:
            raise ValueError(f"blocks = {self.blocks}, heads = {self.heads}: must be of as many levels, 2 or more")
        if self.norm not in ("with_bias", "bias_free"):
            raise ValueError(f"norm = {self.norm!r}, must be 'with_bias' or 'bias_free'")
        for level, heads in enumerate(self.heads):
            if self.width * 2**level % (2 * heads):
                raise ValueError(f"width = {self.width}: level {level} has {self.width * 2**level} channels, "
                                 f"must be a multiple of twice its {heads} heads")

    @property
    def multiple(self) -> int:
        """Sides of an image are padded to multiples of it."""
        return self.unshuffle * 2 ** (len(self.blocks) - 1)

    def card(self) -> dict:
        return {"network": "restormer", **{key: list(value) if isinstance(value, tuple) else value
                                           for key, value in asdict(self).items()}}


class ChannelNorm(nn.Module):
    """Layer normalisation of each pixel's channels."""

    def __init__(self, channels: int, norm: str) -> None:
        super().__init__()
        self.weight = nn.Parameter(torch.ones(channels))
        self.bias = nn.Parameter(torch.zeros(channels)) if norm == "with_bias" else None

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        mean = x.mean(1, keepdim=True)
        centred = x - mean
        scale = torch.rsqrt(centred.square().mean(1, keepdim=True) + 1e-5)
        if self.bias is None:
            return x * scale * self.weight[:, None, None]  # the authors' one does not subtract the mean
        return centred * scale * self.weight[:, None, None] + self.bias[:, None, None]


class Attention(nn.Module):
    """Multi-Dconv head transposed attention: of channels, not of pixels (their section 3.1)."""

    def __init__(self, channels: int, heads: int) -> None:
        super().__init__()
        self.heads = heads
        self.temperature = nn.Parameter(torch.ones(heads))
        self.qkv = nn.Conv2d(channels, 3 * channels, 1, bias=False)
        self.depthwise = nn.Conv2d(3 * channels, 3 * channels, 3, padding=1, groups=3 * channels, bias=False)
        self.project = nn.Conv2d(channels, channels, 1, bias=False)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        count, channels, height, width = x.shape
        q, k, v = self.depthwise(self.qkv(x)).reshape(count, 3, self.heads, -1, height * width).unbind(1)
        q, k = F.normalize(q, dim=-1), F.normalize(k, dim=-1)
        weights = torch.softmax(q @ k.transpose(-2, -1) * self.temperature[:, None, None], dim=-1)
        return self.project((weights @ v).reshape(count, channels, height, width))


class FeedForward(nn.Module):
    """Gated-Dconv feed-forward part (their section 3.2)."""

    def __init__(self, channels: int, expansion: float) -> None:
        super().__init__()
        hidden = int(channels * expansion)
        self.project_in = nn.Conv2d(channels, 2 * hidden, 1, bias=False)
        self.depthwise = nn.Conv2d(2 * hidden, 2 * hidden, 3, padding=1, groups=2 * hidden, bias=False)
        self.project_out = nn.Conv2d(hidden, channels, 1, bias=False)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        gate, value = self.depthwise(self.project_in(x)).chunk(2, dim=1)
        return self.project_out(F.gelu(gate) * value)


class Block(nn.Module):
    def __init__(self, channels: int, heads: int, shape: Shape) -> None:
        super().__init__()
        self.norm1 = ChannelNorm(channels, shape.norm)
        self.attention = Attention(channels, heads)
        self.norm2 = ChannelNorm(channels, shape.norm)
        self.feed_forward = FeedForward(channels, shape.expansion)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        x = x + self.attention(self.norm1(x))
        return x + self.feed_forward(self.norm2(x))


class Restormer(nn.Module):
    """N x 3 x H x W in [0, 1] -> the same, sharpened. H and W are multiples of shape.multiple (see whole())."""

    def __init__(self, shape: Shape) -> None:
        super().__init__()
        self.shape = shape
        channels = [shape.width * 2**level for level in range(len(shape.blocks))]
        folded = 3 * shape.unshuffle**2

        def blocks(count: int, width: int, heads: int) -> nn.Sequential:
            return nn.Sequential(*(Block(width, heads, shape) for _ in range(count)))

        def mix(before: int, after: int, side: int) -> nn.Conv2d:
            return nn.Conv2d(before, after, side, padding=side // 2, bias=False)

        self.embed = mix(folded, channels[0], 3)
        self.encoder = nn.ModuleList(blocks(*level) for level in zip(shape.blocks, channels, shape.heads))
        self.down = nn.ModuleList(mix(width, width // 2, 3) for width in channels[:-1])
        self.up = nn.ModuleList(mix(width, 2 * width, 3) for width in channels[1:])
        # The first level's features are not reduced after they are joined: it goes on with twice its channels.
        self.reduce = nn.ModuleList(mix(2 * width, width, 1) if level else nn.Identity()
                                    for level, width in enumerate(channels[:-1]))
        after = [2 * channels[0], *channels[1:-1]]
        self.decoder = nn.ModuleList(blocks(*level) for level in zip(shape.blocks, after, shape.heads))
        self.refinement = blocks(shape.refinement, after[0], shape.heads[0])
        self.output = mix(after[0], folded, 3)
        nn.init.zeros_(self.output.weight)  # begins as a network that changes nothing

    def forward(self, image: torch.Tensor) -> torch.Tensor:
        side = self.shape.unshuffle
        x = self.embed(F.pixel_unshuffle(image, side))
        skipped = []
        for level, down in enumerate(self.down):
            skipped.append(self.encoder[level](x))
            x = F.pixel_unshuffle(down(skipped[-1]), 2)
        x = self.encoder[-1](x)
        for level in reversed(range(len(self.up))):
            x = torch.cat((F.pixel_shuffle(self.up[level](x), 2), skipped[level]), dim=1)
            x = self.decoder[level](self.reduce[level](x))
        return image + F.pixel_shuffle(self.output(self.refinement(x)), side)

    def whole(self, image: torch.Tensor) -> torch.Tensor:
        """Of any size: reflected at the right and the bottom to what the network takes."""
        height, width = image.shape[-2:]
        lack_y, lack_x = -height % self.shape.multiple, -width % self.shape.multiple
        return self(F.pad(image, (0, lack_x, 0, lack_y), mode="reflect"))[..., :height, :width]
