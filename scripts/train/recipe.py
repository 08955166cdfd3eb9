"""The JSON that says how a network is trained: what it may hold, checked, with its defaults."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from restormer import Shape

# Every key with its default; None: must be given.
KEYS: dict[str, Any] = {
    "name": None,
    "seed": 0,
    "network": None,      # restormer.Shape
    "tile": 256,          # px: the largest image that goes through the network at a time; overlap: of two tiles
    "overlap": 32,
    "pairs": None,        # [{"dataset": folder, "stacked": folder, "weight": 1}], folders below --data
    "hold_out": 0.1,      # share of the sources, whole photographs, that only validation sees
    "loss": "l1",         # or "l2", or "psnr": square error by the frame's, so that each frame counts by its dB
    "optimiser": {"rate": 3e-4, "last_rate": 1e-6, "weight_decay": 1e-4},  # AdamW, cosine
    "stages": None,       # [{"iterations": n, "patch": px, "batch": n}, ...]
    "average": 0.0,       # of the weights over the iterations: decay each, 0: none
    "validate": {"every": 1000, "count": 64, "patch": 128},
    "checkpoint_every": 500,
}
LOSSES = ("l1", "l2", "psnr")


def read(path: str) -> dict[str, Any]:
    """The recipe with defaults filled in. Raises ValueError, which names the file and the key."""
    try:
        given = json.loads(Path(path).read_text())
    except json.JSONDecodeError as error:
        raise ValueError(f"{path}: is no JSON: {error}") from None
    recipe = _filled(path, given, KEYS, "")
    try:
        shape = Shape(**recipe["network"])
    except (TypeError, ValueError) as error:
        raise ValueError(f"{path}: network: {error}") from None
    if recipe["loss"] not in LOSSES:
        raise ValueError(f"{path}: loss = {recipe['loss']!r}, must be one of {', '.join(LOSSES)}")
    for number, stage in enumerate(recipe["stages"]):
        if set(stage) != {"iterations", "patch", "batch"} or min(stage.values()) < 1:
            raise ValueError(f"{path}: stages[{number}] = {stage}, must have iterations, patch and batch, 1 or more")
    for side in [stage["patch"] for stage in recipe["stages"]] + [recipe["validate"]["patch"], recipe["tile"]]:
        if side % shape.multiple:
            raise ValueError(f"{path}: a patch or tile of {side} px, must be a multiple of {shape.multiple}")
    for number, pairs in enumerate(recipe["pairs"]):
        if "dataset" not in pairs or set(pairs) - {"dataset", "stacked", "weight"}:
            raise ValueError(f"{path}: pairs[{number}] has {', '.join(pairs)}, "
                             "must have dataset, and may have stacked and weight")
    if not 0 <= 2 * recipe["overlap"] < recipe["tile"]:
        raise ValueError(f"{path}: overlap = {recipe['overlap']}, must be less than half of tile = {recipe['tile']}")
    return recipe


def _filled(path: str, given: dict[str, Any], keys: dict[str, Any], room: str) -> dict[str, Any]:
    for key in given:
        if key not in keys:
            raise ValueError(f"{path}: unknown key {room}{key}; {', '.join(keys)} are those there are")
    for key, value in keys.items():
        if value is None and key not in given:
            raise ValueError(f"{path}: {room}{key} is missing")
    return {key: _filled(path, given.get(key, {}), value, f"{room}{key}.") if isinstance(value, dict)
            else given.get(key, value) for key, value in keys.items()}


def iterations(recipe: dict[str, Any]) -> int:
    return sum(stage["iterations"] for stage in recipe["stages"])


def fingerprint(recipe: dict[str, Any]) -> str:
    """Of what the weights depend on: a run is taken up again with the same of it only."""
    weighty = {key: value for key, value in recipe.items()
               if key not in ("name", "tile", "overlap", "validate", "checkpoint_every")}
    return hashlib.sha256(json.dumps(weighty, sort_keys=True).encode()).hexdigest()[:16]


def smoke(recipe: dict[str, Any]) -> dict[str, Any]:
    """The same in little: twenty iterations of two small patches, to see that everything runs."""
    multiple = Shape(**recipe["network"]).multiple
    patch = -(-32 // multiple) * multiple
    return {**recipe, "stages": [{"iterations": 20, "patch": patch, "batch": 2}],
            "validate": {"every": 10, "count": 2, "patch": patch}, "checkpoint_every": 10}
