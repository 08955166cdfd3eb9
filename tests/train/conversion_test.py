#!/usr/bin/python3
"""Checkpoints in the names of other people's Restormers, converted: the same network, computed here by their names.

The two schemes are those of swz30/Restormer (basicsr/models/archs/restormer_arch.py) and of Riponcs/Turb-Seg-Res
(TrainRestormer/model.py).

  conversion_test.py
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TRAIN = pathlib.Path(__file__).resolve().parents[2] / "scripts/train"
sys.path.insert(0, str(TRAIN))
SKIPPED = 77  # as tests/CMakeLists.txt knows it

try:
    import torch
    from torch.nn import functional as F
except ImportError:
    print("skipped: needs torch (scripts/setup.sh --training)")
    sys.exit(SKIPPED)

import weights

WIDTH, BLOCKS, HEADS, REFINEMENT, EXPANSION = 8, (1, 2, 1, 2), (1, 2, 4, 8), 1, 2.66

# What a block's parts are called in each, in the order of BLOCK.
BLOCK = ("norm1", "temperature", "qkv", "depthwise", "project", "norm2", "project_in", "ffn_depthwise", "project_out")
SCHEMES = {
    "authors": ("norm1.body", "attn.temperature", "attn.qkv", "attn.qkv_dwconv", "attn.project_out", "norm2.body",
                "ffn.project_in", "ffn.dwconv", "ffn.project_out"),
    "papers": ("norm1", "attn.temperature", "attn.qkv", "attn.qkv_conv", "attn.project_out", "norm2",
               "ffn.project_in", "ffn.conv", "ffn.project_out")}
# Its stages by level: what they are called.
STAGES = {
    "authors": {"embed": "patch_embed.proj", "encoder": "encoder_level{1}", "bottom": "latent",
                "down": "down{1}_{2}.body.0", "up": "up{2}_{1}.body.0", "reduce": "reduce_chan_level{1}",
                "decoder": "decoder_level{1}"},
    "papers": {"embed": "embed_conv", "encoder": "encoders.{0}", "bottom": "encoders.3", "down": "downs.{0}.body.0",
               "up": "ups.{3}.body.0", "reduce": "reduces.{3}", "decoder": "decoders.{3}"}}


class Theirs:
    """A network with random weights in a scheme's names, which come into being as the forward pass asks for them."""

    def __init__(self, scheme, with_bias):
        self.scheme, self.with_bias, self.state = scheme, with_bias, {}
        self.random = torch.Generator().manual_seed(5)
        with torch.no_grad():
            self.image = torch.rand(1, 3, 24, 32, generator=self.random)
            self.output = self(self.image)

    def get(self, name, *shape, around=0.0):
        if name not in self.state:
            self.state[name] = around + 0.3 * torch.randn(*shape, generator=self.random) / max(1, shape[-1]) ** 0.5
        return self.state[name]

    def stage(self, kind, level):
        # Level from 0; from 1; the one below from 1; from the bottom up.
        return STAGES[self.scheme][kind].format(level, level + 1, level + 2, 2 - level)

    def norm(self, x, name):
        channels = x.shape[1]
        weight = self.get(f"{name}.weight", channels, around=1.0)[:, None, None]
        scale = torch.sqrt(x.var(1, keepdim=True, unbiased=False) + 1e-5)
        if not self.with_bias:
            return x / scale * weight
        return (x - x.mean(1, keepdim=True)) / scale * weight + self.get(f"{name}.bias", channels)[:, None, None]

    def mix(self, x, name, channels, side=1, depthwise=False):
        groups = channels if depthwise else 1
        weight = self.get(f"{name}.weight", channels, x.shape[1] // groups, side, side)
        return F.conv2d(x, weight, padding=side // 2, groups=groups)

    def block(self, x, prefix, heads):
        names = dict(zip(BLOCK, (f"{prefix}.{part}" for part in SCHEMES[self.scheme])))
        batch, channels, height, width = x.shape
        qkv = self.mix(self.norm(x, names["norm1"]), names["qkv"], 3 * channels)
        qkv = self.mix(qkv, names["depthwise"], 3 * channels, 3, depthwise=True)
        q, k, v = (part.reshape(batch, heads, -1, height * width) for part in qkv.chunk(3, dim=1))
        shape = (1, heads, 1, 1) if self.scheme == "papers" else (heads, 1, 1)
        temperature = self.get(names["temperature"], *shape, around=1.0)
        weights_ = torch.softmax(F.normalize(q, dim=-1) @ F.normalize(k, dim=-1).transpose(-2, -1) * temperature, -1)
        x = x + self.mix((weights_ @ v).reshape(x.shape), names["project"], channels)
        hidden = int(channels * EXPANSION)
        y = self.mix(self.norm(x, names["norm2"]), names["project_in"], 2 * hidden)
        gate, value = self.mix(y, names["ffn_depthwise"], 2 * hidden, 3, depthwise=True).chunk(2, dim=1)
        return x + self.mix(F.gelu(gate) * value, names["project_out"], channels)

    def blocks(self, x, prefix, count, heads):
        for number in range(count):
            x = self.block(x, f"{prefix}.{number}", heads)
        return x

    def __call__(self, image):
        x = self.mix(image, STAGES[self.scheme]["embed"], WIDTH, 3)
        skipped = []
        for level in range(3):
            skipped.append(self.blocks(x, self.stage("encoder", level), BLOCKS[level], HEADS[level]))
            x = F.pixel_unshuffle(self.mix(skipped[-1], self.stage("down", level), WIDTH * 2**level // 2, 3), 2)
        x = self.blocks(x, STAGES[self.scheme]["bottom"], BLOCKS[3], HEADS[3])
        for level in (2, 1, 0):
            x = F.pixel_shuffle(self.mix(x, self.stage("up", level), WIDTH * 2 ** (level + 2), 3), 2)
            x = torch.cat((x, skipped[level]), dim=1)
            if level:
                x = self.mix(x, self.stage("reduce", level), WIDTH * 2**level)
            x = self.blocks(x, self.stage("decoder", level), BLOCKS[level], HEADS[level])
        x = self.blocks(x, "refinement", REFINEMENT, HEADS[0])
        return image + self.mix(x, "output", 3, 3)


class Conversion(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="shimmer-conversion-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def convert(self, checkpoint, *arguments):
        torch.save(checkpoint, self.folder / "theirs.pth")
        return subprocess.run([sys.executable, str(TRAIN / "convert_weights.py"), str(self.folder / "theirs.pth"), "--out",
                               str(self.folder / "ours.safetensors"), *arguments], capture_output=True, text=True)

    def refused(self, checkpoint, *parts):
        run = self.convert(checkpoint)
        self.assertEqual(run.returncode, 1)
        self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
        for part in ("convert_weights.py: ", "theirs.pth: ", *parts):
            self.assertIn(part, run.stderr)
        self.assertFalse((self.folder / "ours.safetensors").exists())

    def test_both_schemes_give_the_same_network(self):
        import export
        wraps = (lambda state: state, lambda state: {"params": state},
                 lambda state: {"state_dict": {f"module.{name}": value for name, value in state.items()}})
        for scheme, with_bias in (("authors", True), ("authors", False), ("papers", True)):
            theirs = Theirs(scheme, with_bias)
            for wrap in wraps:
                run = self.convert(wrap(theirs.state), "--tile", "128", "--overlap", "8")
                self.assertEqual((run.returncode, run.stderr), (0, ""))
                network, card = export.load(self.folder / "ours.safetensors")
                with torch.no_grad():
                    error = (network(theirs.image) - theirs.output).abs().max() / theirs.output.abs().max()
                self.assertLess(error.item(), 2e-6)  # the sums' order
            self.assertEqual((card["width"], card["blocks"], card["heads"], card["refinement"], card["norm"]),
                             (WIDTH, list(BLOCKS), list(HEADS), REFINEMENT, "with_bias" if with_bias else "bias_free"))
            self.assertEqual((card["tile"], card["overlap"], card["unshuffle"]), (128, 8, 1))
            tensors, _ = weights.read(self.folder / "ours.safetensors")
            self.assertEqual(tensors["sample.output"].shape, (3, 64, 64))

    def test_says_what_is_wrong(self):
        state = Theirs("authors", True).state
        self.refused({"conv1.weight": torch.zeros(3)}, "has neither patch_embed.proj.weight")
        self.refused({**state, "skip_conv.weight": torch.zeros(16, 8, 1, 1)}, "skip_conv.weight: is not in a Restormer")
        self.refused({name: value for name, value in state.items() if name != "output.weight"}, "output.weight")
        self.refused({**state, "output.weight": torch.zeros(4, 16, 3, 3)}, "output.weight")
        self.refused({**state, "output.weight": torch.full((3, 16, 3, 3), float("nan"))}, "not finite")
        self.refused([1, 2])
        (self.folder / "theirs.pth").write_bytes(b"no checkpoint")
        run = subprocess.run([sys.executable, str(TRAIN / "convert_weights.py"), str(self.folder / "theirs.pth"), "--out",
                              str(self.folder / "ours.safetensors")], capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stderr.count("\n")), (1, 1), run.stderr)

    def test_another_expansion_is_asked_for(self):
        state = Theirs("papers", True).state
        run = self.convert(state, "--expansion", "2")
        self.assertEqual(run.returncode, 1)
        self.assertIn("have 21 channels for 8, must be 16 with an expansion of 2.0: say --expansion", run.stderr)


if __name__ == "__main__":
    unittest.main()
