#!/usr/bin/python3
"""Turns a PyTorch checkpoint of a Restormer into weights for unshimmer.

    convert_weights.py CHECKPOINT.pth --out FILE.safetensors [--expansion 2.66] [--tile 384]

Takes checkpoints of the Restormer authors' code (swz30/Restormer) and of what the paper's authors train with
(Riponcs/Turb-Seg-Res, TrainRestormer; also leftthomas/Restormer): four levels, three channels in and out. How the network
is built is read from its tensors; only how the feed-forward parts' width was rounded can't be, so --expansion says it.
"""

from __future__ import annotations

import argparse
import pickle
import re
import sys
from pathlib import Path
from typing import Any, Callable, Mapping

import torch

import weights
from restormer import Restormer, Shape
from sample import record

LEVELS = 4
BOTTOM = LEVELS - 1

# Parts of a block, as theirs are called -> ours.
PARTS = {"norm1.body": "norm1", "norm2.body": "norm2", "attn.qkv": "attention.qkv", "attn.qkv_dwconv": "attention.depthwise",
         "attn.qkv_conv": "attention.depthwise", "attn.project_out": "attention.project",
         "attn": "attention", "ffn.project_in": "feed_forward.project_in", "ffn.dwconv": "feed_forward.depthwise",
         "ffn.conv": "feed_forward.depthwise", "ffn.project_out": "feed_forward.project_out"}


# Whole names of each scheme, as patterns, and ours. Where theirs count otherwise, {n} is the level from 0.
AUTHORS = ((r"(encoder|decoder)_level(?P<n>\d)\.(.*)", r"\1.{n}.\3"), (r"latent\.(.*)", rf"encoder.{BOTTOM}.\1"),
           (r"down(?P<n>\d)_\d\.body\.0\.(.*)", r"down.{n}.\2"), (r"up\d_(?P<n>\d)\.body\.0\.(.*)", r"up.{n}.\2"),
           (r"reduce_chan_level(?P<n>\d)\.(.*)", r"reduce.{n}.\2"), (r"patch_embed\.proj\.(.*)", r"embed.\1"),
           (r"((?:refinement|output)\..*)", r"\1"))
PAPERS = ((r"encoders\.(.*)", r"encoder.\1"), (r"downs\.(\d)\.body\.0\.(.*)", r"down.\1.\2"),
          (r"ups\.(?P<n>\d)\.body\.0\.(.*)", r"up.{n}.\2"), (r"reduces\.(?P<n>\d)\.(.*)", r"reduce.{n}.\2"),
          (r"decoders\.(?P<n>\d)\.(.*)", r"decoder.{n}.\2"), (r"embed_conv\.(.*)", r"embed.\1"),
          (r"((?:refinement|output)\..*)", r"\1"))
# By a name that each has: swz30/Restormer counts levels from 1, TrainRestormer from the bottom on the way up.
SCHEMES = {"patch_embed.proj.weight": (AUTHORS, lambda number: number - 1),
           "embed_conv.weight": (PAPERS, lambda number: BOTTOM - 1 - number)}


def _in_ours(name: str, patterns: tuple[tuple[str, str], ...], level: Callable[[int], int]) -> str:
    for pattern, ours in patterns:
        if match := re.fullmatch(pattern, name):
            return match.expand(ours.replace("{n}", str(level(int(match["n"])))) if "{n}" in ours else ours)
    raise ValueError(f"{name}: is not in a Restormer of three channels in and out (dual-pixel ones are not taken)")


def _in_our_names(state: Mapping[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    scheme = next((scheme for name, scheme in SCHEMES.items() if name in state), None)
    if scheme is None:
        raise ValueError("has neither patch_embed.proj.weight (swz30/Restormer) nor embed_conv.weight "
                         "(TrainRestormer): is no Restormer whose names are known")
    renamed = {}
    for name, tensor in state.items():
        ours = _in_ours(name, *scheme)
        if match := re.fullmatch(r"((?:encoder|decoder)\.\d+\.\d+|refinement\.\d+)\.(.+)\.(weight|bias|temperature)", ours):
            ours = f"{match[1]}.{PARTS.get(match[2], match[2])}.{match[3]}"
        renamed[ours] = tensor.flatten() if ours.endswith("temperature") else tensor
    return renamed


def shape_of(tensors: Mapping[str, torch.Tensor], expansion: float) -> Shape:
    """How a network with these tensors is built. Raises ValueError where they are of none."""
    def count(prefix: str) -> int:
        return len({match[1] for name in tensors if (match := re.match(re.escape(prefix) + r"\.(\d+)\.", name))})

    norm = "with_bias" if "encoder.0.0.norm1.bias" in tensors else "bias_free"
    shape = Shape(width=tensors["embed.weight"].shape[0], blocks=tuple(count(f"encoder.{level}") for level in range(LEVELS)),
                  heads=tuple(tensors[f"encoder.{level}.0.attention.temperature"].numel() for level in range(LEVELS)),
                  refinement=count("refinement"), expansion=expansion, norm=norm)
    hidden = tensors["encoder.0.0.feed_forward.project_out.weight"].shape[1]
    if hidden != int(shape.width * expansion):
        raise ValueError(f"its feed-forward parts have {hidden} channels for {shape.width}, must be "
                         f"{int(shape.width * expansion)} with an expansion of {expansion}: say --expansion")
    return shape


def network_of(checkpoint: Any, expansion: float) -> Restormer:
    """checkpoint: what torch.load gave: tensors by name, alone or under "params" or "state_dict"."""
    for key in ("params_ema", "params", "state_dict"):
        checkpoint = checkpoint[key] if key in checkpoint else checkpoint
    state = {name.removeprefix("module."): tensor for name, tensor in checkpoint.items()}
    tensors = _in_our_names(state)
    network = Restormer(shape_of(tensors, expansion))
    try:
        network.load_state_dict(tensors)
    except RuntimeError as error:  # names each tensor that lacks, is too many or of another shape, a line each
        raise ValueError(" ".join(line.strip() for line in str(error).splitlines()[1:])) from None
    return network.eval()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkpoint", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--expansion", type=float, default=2.66, help="of the feed-forward parts, default 2.66")
    parser.add_argument("--tile", type=int, default=384, help="px that go through at a time: as in training, default 384")
    parser.add_argument("--overlap", type=int, default=32, help="px of two tiles, default 32")
    arguments = parser.parse_args()
    try:
        network = network_of(torch.load(arguments.checkpoint, map_location="cpu"), arguments.expansion)
        tensors = {name: value.float().numpy() for name, value in network.state_dict().items()}
        card = {"format": 1, "name": arguments.checkpoint.stem, **network.shape.card(), "tile": arguments.tile,
                "overlap": arguments.overlap, "converted_from": arguments.checkpoint.name}
        weights.write(arguments.out, {**tensors, **record(network)}, card)
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RuntimeError, pickle.UnpicklingError) as error:
        sys.exit(f"convert_weights.py: {arguments.checkpoint}: {error}")


if __name__ == "__main__":
    main()
