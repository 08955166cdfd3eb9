"""Weights as unshimmer reads them: safetensors, with a model card in their metadata (docs/formats.md, "Weights").

    write("small.safetensors", {"embed.weight": array, ...}, card)
    tensors, card = read("small.safetensors")
"""

from __future__ import annotations

import json
import os
import struct
from pathlib import Path
from typing import Any, Mapping

import numpy as np

TYPES = {"F16": np.float16, "F32": np.float32}


def write(path: str | os.PathLike, tensors: Mapping[str, np.ndarray], card: Mapping[str, Any]) -> None:
    """Tensors are float16 or float32. The file stands there once it is whole."""
    header: dict[str, Any] = {"__metadata__": {"card": json.dumps(card, allow_nan=False)}}
    end = 0
    for name, tensor in tensors.items():
        kind = next((kind for kind, numpy_type in TYPES.items() if tensor.dtype == numpy_type), None)
        if kind is None:
            raise ValueError(f"{name}: is {tensor.dtype}, must be float16 or float32")
        if not np.isfinite(tensor).all():
            raise ValueError(f"{name}: holds values that are not finite" +
                             (" as float16" if kind == "F16" else ""))
        header[name] = {"dtype": kind, "shape": list(tensor.shape), "data_offsets": [end, end + tensor.nbytes]}
        end += tensor.nbytes
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)  # data begin at a multiple of 8
    part = Path(f"{path}.part")
    with open(part, "wb") as file:
        file.write(struct.pack("<Q", len(text)))
        file.write(text)
        for tensor in tensors.values():
            file.write(np.ascontiguousarray(tensor).tobytes())
        file.flush()
        os.fsync(file.fileno())
    os.replace(part, path)


def read(path: str | os.PathLike) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Tensors and card. Raises ValueError, which names the file, for what is no such file."""
    data = Path(path).read_bytes()
    try:
        length, = struct.unpack_from("<Q", data)
        header = json.loads(data[8:8 + length])
        card = json.loads(header.pop("__metadata__")["card"])
        tensors = {}
        for name, tensor in header.items():
            begin, end = tensor["data_offsets"]
            flat = np.frombuffer(data[8 + length + begin:8 + length + end], TYPES[tensor["dtype"]])
            tensors[name] = flat.reshape(tensor["shape"])
    except (struct.error, KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{path}: is no file of weights with a model card: {error}") from None
    return tensors, card
