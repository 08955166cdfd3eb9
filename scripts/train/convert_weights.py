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
from typing import Any, Mapping

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


def _authors(name: str) -> str | None:
    """A name of swz30/Restormer in ours. Its levels are counted from 1; None: it is none of its names."""
    if match := re.fullmatch(r"(encoder|decoder)_level(\d)\.(.*)", name):
        return f"{match[1]}.{int(match[2]) - 1}.{match[3]}"
    if match := re.fullmatch(r"latent\.(.*)", name):
        return f"encoder.{BOTTOM}.{match[1]}"
    if match := re.fullmatch(r"down(\d)_\d\.body\.0\.(.*)", name):
        return f"down.{int(match[1]) - 1}.{match[2]}"
    if match := re.fullmatch(r"up\d_(\d)\.body\.0\.(.*)", name):
        return f"up.{int(match[1]) - 1}.{match[2]}"
    if match := re.fullmatch(r"reduce_chan_level(\d)\.(.*)", name):
        return f"reduce.{int(match[1]) - 1}.{match[2]}"
    if match := re.fullmatch(r"patch_embed\.proj\.(.*)", name):
        return f"embed.{match[1]}"
    return name if re.match(r"(refinement|output)\.", name) else None


def _papers(name: str) -> str | None:
    """A name of TrainRestormer in ours. On its way up it counts from the bottom; None: it is none of its names."""
    if match := re.fullmatch(r"encoders\.(.*)", name):
        return f"encoder.{match[1]}"
    if match := re.fullmatch(r"downs\.(\d)\.body\.0\.(.*)", name):
        return f"down.{match[1]}.{match[2]}"
    if match := re.fullmatch(r"ups\.(\d)\.body\.0\.(.*)", name):
        return f"up.{BOTTOM - 1 - int(match[1])}.{match[2]}"
    if match := re.fullmatch(r"reduces\.(\d)\.(.*)", name):
        return f"reduce.{BOTTOM - 1 - int(match[1])}.{match[2]}"
    if match := re.fullmatch(r"decoders\.(\d)\.(.*)", name):
        return f"decoder.{BOTTOM - 1 - int(match[1])}.{match[2]}"
    if match := re.fullmatch(r"embed_conv\.(.*)", name):
        return f"embed.{match[1]}"
    return name if re.match(r"(refinement|output)\.", name) else None


def _in_our_names(state: Mapping[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    scheme = _authors if "patch_embed.proj.weight" in state else _papers if "embed_conv.weight" in state else None
    if scheme is None:
        raise ValueError("has neither patch_embed.proj.weight (swz30/Restormer) nor embed_conv.weight "
                         "(TrainRestormer): is no Restormer whose names are known")
    renamed = {}
    for name, tensor in state.items():
        ours = scheme(name)
        if ours is None:
            raise ValueError(f"{name}: is not in a Restormer of three channels in and out (dual-pixel ones are not taken)")
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
