#!/usr/bin/env python3
"""Writes the small Restormers of this folder: random weights, an input, and what PyTorch makes of it.

    make_restormer.py [FOLDER]        needs python3-torch and python3-numpy

The network is that of Zamir et al. (CVPR 2022), written as functions of the tensors that
restore/restormer_tensors.h lists. Weights that the file keeps in half precision are rounded before they are used.
"""
import json
import math
import pathlib
import struct
import sys

import numpy as np
import torch
import torch.nn.functional as F


def block_tensors(card, channels, heads):
    hidden = int(channels * card["expansion"])
    norm = {"weight": [channels]}
    if card["norm"] == "with_bias":
        norm["bias"] = [channels]
    shapes = {f"norm{i}.{key}": shape for i in (1, 2) for key, shape in norm.items()}
    shapes |= {
        "attention.temperature": [heads],
        "attention.qkv.weight": [3 * channels, channels, 1, 1],
        "attention.depthwise.weight": [3 * channels, 1, 3, 3],
        "attention.project.weight": [channels, channels, 1, 1],
        "feed_forward.project_in.weight": [2 * hidden, channels, 1, 1],
        "feed_forward.depthwise.weight": [2 * hidden, 1, 3, 3],
        "feed_forward.project_out.weight": [channels, hidden, 1, 1],
    }
    return shapes


def tensor_shapes(card):
    width, blocks, heads, bottom = card["width"], card["blocks"], card["heads"], len(card["blocks"]) - 1
    image = 3 * card["unshuffle"] ** 2
    shapes = {"embed.weight": [width, image, 3, 3], "output.weight": [image, 2 * width, 3, 3]}

    def add(stage, count, channels, of_heads):
        for i in range(count):
            shapes.update({f"{stage}.{i}.{k}": v for k, v in block_tensors(card, channels, of_heads).items()})

    for level in range(bottom + 1):
        c = width << level
        add(f"encoder.{level}", blocks[level], c, heads[level])
        if level < bottom:
            shapes[f"down.{level}.weight"] = [c // 2, c, 3, 3]
            shapes[f"up.{level}.weight"] = [4 * c, 2 * c, 3, 3]
            if level > 0:
                shapes[f"reduce.{level}.weight"] = [c, 2 * c, 1, 1]
            add(f"decoder.{level}", blocks[level], c if level else 2 * c, heads[level])
    add("refinement", card["refinement"], 2 * width, heads[0])
    return shapes


def random_weights(card, generator):
    weights = {}
    for name, shape in tensor_shapes(card).items():
        value = torch.randn(shape, generator=generator)
        if name.endswith((".bias",)):
            value *= 0.1
        elif len(shape) == 1:  # of norms, and temperatures
            value = 1 + 0.2 * value
        else:
            value *= (0.3 if name == "output.weight" else 1) / math.sqrt(np.prod(shape[1:]))
        weights[name] = value
    return weights


class Network:
    def __init__(self, card, weights):
        self.card, self.weights = card, weights

    def convolve(self, x, name, groups=1):
        weight = self.weights[name + ".weight"]
        return F.conv2d(x, weight, padding=weight.shape[-1] // 2, groups=groups)

    def normalise(self, x, name):
        variance = x.var(1, keepdim=True, unbiased=False)
        weight = self.weights[name + ".weight"].view(1, -1, 1, 1)
        if self.card["norm"] == "bias_free":
            return x / torch.sqrt(variance + 1e-5) * weight
        bias = self.weights[name + ".bias"].view(1, -1, 1, 1)
        return (x - x.mean(1, keepdim=True)) / torch.sqrt(variance + 1e-5) * weight + bias

    def attend(self, x, name, heads):
        _, channels, height, width = x.shape
        qkv = self.convolve(self.convolve(x, name + "qkv"), name + "depthwise", 3 * channels)
        q, k, v = (part.reshape(heads, channels // heads, height * width) for part in qkv.chunk(3, 1))
        scores = F.normalize(q, dim=-1) @ F.normalize(k, dim=-1).transpose(1, 2)
        shares = (scores * self.weights[name + "temperature"].view(heads, 1, 1)).softmax(-1)
        return self.convolve((shares @ v).reshape(x.shape), name + "project")

    def feed_forward(self, x, name):
        x = self.convolve(x, name + "project_in")
        a, b = self.convolve(x, name + "depthwise", x.shape[1]).chunk(2, 1)
        return self.convolve(F.gelu(a) * b, name + "project_out")

    def blocks(self, x, stage, count, heads):
        for i in range(count):
            name = f"{stage}.{i}."
            x = x + self.attend(self.normalise(x, name + "norm1"), name + "attention.", heads)
            x = x + self.feed_forward(self.normalise(x, name + "norm2"), name + "feed_forward.")
        return x

    def level(self, x, level):
        count, heads = self.card["blocks"][level], self.card["heads"][level]
        x = self.blocks(x, f"encoder.{level}", count, heads)
        if level + 1 == len(self.card["blocks"]):
            return x
        below = self.level(F.pixel_unshuffle(self.convolve(x, f"down.{level}"), 2), level + 1)
        x = torch.cat([F.pixel_shuffle(self.convolve(below, f"up.{level}"), 2), x], 1)
        if level > 0:
            x = self.convolve(x, f"reduce.{level}")
        return self.blocks(x, f"decoder.{level}", count, heads)

    def run(self, image):
        u, (height, width) = self.card["unshuffle"], image.shape[-2:]
        multiple = u << (len(self.card["blocks"]) - 1)
        padded = F.pad(image, (0, -width % multiple, 0, -height % multiple), mode="reflect")
        x = self.convolve(F.pixel_unshuffle(padded, u), "embed")
        x = self.blocks(self.level(x, 0), "refinement", self.card["refinement"], self.card["heads"][0])
        return (padded + F.pixel_shuffle(self.convolve(x, "output"), u))[..., :height, :width]


def write_file(path, card, tensors):
    header, data = {"__metadata__": {"card": json.dumps(card)}}, b""
    for name, value in tensors.items():
        bytes_of = value.tobytes()
        header[name] = {"dtype": {"float32": "F32", "float16": "F16"}[str(value.dtype)], "shape": list(value.shape),
                        "data_offsets": [len(data), len(data) + len(bytes_of)]}
        data += bytes_of
    text = json.dumps(header).encode()
    path.write_bytes(struct.pack("<Q", len(text)) + text + data)


def make(path, card, size, half, seed):
    card = {"format": 1, "network": "restormer", "name": path.stem, "tile": 256, "overlap": 32, "seed": seed} | card
    generator = torch.Generator().manual_seed(seed)
    weights = random_weights(card, generator)
    if half:
        weights = {name: value.half().float() for name, value in weights.items()}
    image = torch.rand((1, 3, *size), generator=generator)
    output = Network(card, weights).run(image)
    tensors = {name: value.numpy().astype(np.float16 if half else np.float32) for name, value in weights.items()}
    tensors |= {"sample.input": image[0].numpy(), "sample.output": output[0].numpy()}
    write_file(path, card, tensors)


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent
    torch.set_num_threads(1)
    make(folder / "restormer_with_bias.safetensors",
         {"width": 8, "blocks": [1, 1, 1], "heads": [1, 2, 4], "refinement": 0, "expansion": 1.3, "norm": "with_bias",
          "unshuffle": 1}, (21, 26), False, 1)
    make(folder / "restormer_bias_free.safetensors",
         {"width": 14, "blocks": [1, 2], "heads": [2, 4], "refinement": 1, "expansion": 2.66, "norm": "bias_free",
          "unshuffle": 2}, (47, 35), True, 2)


if __name__ == "__main__":
    main()
