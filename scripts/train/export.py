#!/usr/bin/python3
"""Writes a network that Shimmer trained as ONNX or TorchScript, for other programs, and for unshimmer --model.

    export.py WEIGHTS.safetensors --out FILE.onnx|FILE.pt [--tile 256]

Beside it goes FILE.onnx.safetensors: a model card with the tile's size, and what the network makes of a sample, which
unshimmer checks. For a network of your own call beside() with it; it takes 1 x 3 x tile x tile in [0, 1] and gives the same.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path

import numpy as np
import torch
from torch import nn

import weights
from restormer import Restormer, Shape
from sample import record

OPSET = 11  # what OpenCV 4.6 imports


def load(path: str | Path) -> tuple[Restormer, dict]:
    """The network of a file of weights, and its card."""
    tensors, card = weights.read(path)
    keys = Shape.__dataclass_fields__
    network = Restormer(Shape(**{key: value for key, value in card.items() if key in keys}))
    network.load_state_dict({name: torch.from_numpy(value.astype(np.float32)) for name, value in tensors.items()
                             if not name.startswith("sample.")})
    return network.eval(), card


def beside(network: nn.Module, out: str | Path, name: str, tile: int, overlap: int) -> None:
    """Writes OUT.safetensors: the card and the recorded sample of a network that is in OUT."""
    weights.write(f"{out}.safetensors", record(network, tile),
                  {"format": 1, "name": name, "tile": tile, "overlap": overlap})


def export(network: nn.Module, out: Path, tile: int) -> None:
    example = torch.zeros(1, 3, tile, tile)
    with warnings.catch_warnings(), torch.no_grad():
        warnings.simplefilter("ignore")  # of tracing: sizes are fixed, as the card says
        if out.suffix == ".onnx":
            torch.onnx.export(network, (example,), str(out), opset_version=OPSET, input_names=["image"],
                              output_names=["sharpened"])
        else:
            torch.jit.trace(network, (example,), check_trace=False).save(str(out))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("weights")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--tile", type=int, help="px, default: the card's")
    arguments = parser.parse_args()
    try:
        if arguments.out.suffix not in (".onnx", ".pt"):
            raise ValueError(f"--out {arguments.out}: must end in .onnx or .pt")
        network, card = load(arguments.weights)
        tile = arguments.tile or card["tile"]
        export(network, arguments.out, tile)
        beside(network, arguments.out, card["name"], tile, min(card["overlap"], tile // 4))
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        sys.exit(f"export.py: {error}")


if __name__ == "__main__":
    main()
