"""How well a network does on sources that training never saw: PSNR and SSIM over its input, by iteration."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any, Sequence

import cv2
import numpy as np
import torch

from pairs import Pairs

FIELDS = ("iteration", "seconds", "loss", "psnr", "input_psnr", "ssim", "input_ssim")


def psnr(a: np.ndarray, b: np.ndarray) -> float:
    """Of arrays in [0, 1], dB."""
    return float(-10 * np.log10(max(np.mean((a.astype(np.float64) - b) ** 2), 1e-10)))


def ssim(a: np.ndarray, b: np.ndarray) -> float:
    """3 x H x W in [0, 1]; the mean over channels and pixels, Gaussian window of sigma 1.5 (Wang et al. 2004)."""
    def blur(x: np.ndarray) -> np.ndarray:
        return cv2.GaussianBlur(x, (11, 11), 1.5, borderType=cv2.BORDER_REFLECT)

    values = []
    for x, y in zip(a.astype(np.float64), b.astype(np.float64)):
        mean_x, mean_y = blur(x), blur(y)
        var_x, var_y, cov = blur(x * x) - mean_x**2, blur(y * y) - mean_y**2, blur(x * y) - mean_x * mean_y
        values.append(np.mean((2 * mean_x * mean_y + 1e-4) * (2 * cov + 9e-4) /
                              ((mean_x**2 + mean_y**2 + 1e-4) * (var_x + var_y + 9e-4))))
    return float(np.mean(values))


class Validation:
    """Rows of curve.csv. A run that is taken up again keeps those until its iteration."""

    def __init__(self, kinds: Sequence[Pairs], held_out: set[str], options: dict[str, Any], path: Path,
                 iteration: int) -> None:
        self.path = path
        self.rows: list[dict[str, Any]] = []
        if path.exists():
            with open(path, newline="") as file:
                self.rows = [row for row in csv.DictReader(file) if int(row["iteration"]) <= iteration]
        patch, self.samples = options["patch"], []
        for pairs in kinds:  # as many of each kind, evenly over its items
            items = [n for n, source in enumerate(pairs.sources) if source in held_out]
            count = min(-(-options["count"] // len(kinds)), len(items))
            for item in items[::max(len(items) // max(count, 1), 1)][:count]:
                turb, clean = pairs[item]
                self.samples.append((turb[:, :patch, :patch], clean[:, :patch, :patch]))

    def add(self, iteration: int, seconds: float, loss: float, network: Any, device: torch.device) -> dict[str, Any]:
        """Measures and writes a row; with no source held out, its figures are nan."""
        scores = []
        for turb, clean in self.samples:
            with torch.no_grad():
                out = network.whole(torch.from_numpy(turb)[None].to(device))[0].cpu().numpy().clip(0, 1)
            scores.append((psnr(out, clean), psnr(turb, clean), ssim(out, clean), ssim(turb, clean)))
        means = np.mean(scores, axis=0) if scores else [np.nan] * 4
        row = dict(zip(FIELDS, [iteration, f"{seconds:.0f}", f"{loss:.6f}", f"{means[0]:.3f}", f"{means[1]:.3f}",
                                f"{means[2]:.4f}", f"{means[3]:.4f}"]))
        self.rows.append(row)
        with open(self.path, "w", newline="") as file:
            writer = csv.DictWriter(file, FIELDS)
            writer.writeheader()
            writer.writerows(self.rows)
        return row


def draw_curve(rows: Sequence[dict[str, Any]], path: Path) -> None:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    iterations = [int(row["iteration"]) for row in rows]
    figure, axis = pyplot.subplots(figsize=(7, 4))
    axis.plot(iterations, [float(row["psnr"]) for row in rows], label="restored")
    axis.plot(iterations, [float(row["input_psnr"]) for row in rows], "--", label="input")
    axis.set_xlabel("iteration")
    axis.set_ylabel("PSNR, dB, of sources that training never saw")
    axis.legend()
    axis.grid(True, alpha=0.3)
    figure.savefig(path, dpi=120, bbox_inches="tight")
    pyplot.close(figure)
