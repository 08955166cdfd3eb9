"""The clips that shimmer generated, as a PyTorch data set: every layout, PNG and EXR, also while they are being made.

    from shimmer_dataset import ShimmerDataset
    train = ShimmerDataset("dataset", split="train", crop=256, flip=True)
    turb, clean = train[0]                      # float32, 3 x 256 x 256, in [0, 1]

    python3 shimmer_dataset.py dataset          # prints what is in a folder

One file: copy it beside your code. It needs numpy and OpenCV (Debian: python3-numpy, python3-opencv); for EXR, which
the truth is, OpenImageIO (python3-openimageio). Without PyTorch (python3-torch), items are numpy arrays.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
from pathlib import Path
from typing import Any, Callable, Iterator, Sequence

import cv2
import numpy as np

try:
    import torch
    from torch.utils.data import Dataset
except ImportError:
    torch, Dataset = None, object

# What a file is, by its folder, or in a tar file by the second part of its name.
KINDS = {"turb": "turb", "lq": "turb", "clean": "clean", "noturb": "clean", "gt": "clean", "truth": "truth",
         "mask": "mask", "flow": "flow", "shake": "shake"}
# channel -> what output.truth calls it, and the kind of file that it is in
TRUTH = {"dx": "tilt", "dy": "tilt", "sigma": "sigma", "mask": "mask", "u": "flow", "v": "flow"}
TRUTH_FILES = {"tilt": "truth", "sigma": "truth", "mask": "mask", "flow": "flow"}


class ShimmerDataset(Dataset):
    """Items are windows of frames of finished clips, ordered by clip: (turb, clean), or (turb, clean, truth).

    With frames=1 each is C x H x W, otherwise T x C x H x W, float32. PNG values are in [0, 1], EXR values as they are
    in the file. Truth is in px, a mask in [0, 1], and stays true where a crop is reflected or an item is flipped. Of a
    clip's last frame there is no flow: its u and v are NaN. mask(), flow() and shake() give the same of an item's whole
    frames, as it is in the files.

    folder     the data set's folder, which holds dataset.json
    split      "train" or "test": by output.test_fraction, the same clips in every layout; None: all
    frames     1, n consecutive ones, or "all" of a clip
    step       frames from the start of an item to the start of the next in its clip; None: as many as frames
    crop       side of a random square, reflected at the frame's right and bottom where that is smaller; None: all of it
    flip       True: half of the items are mirrored left to right
    truth      channels to read, any of "dx", "dy", "sigma"; and of the steady frame "mask", "u", "v"
    rgb        True: a grey frame becomes three equal channels; False: one
    transform  is given the tensors of an item and returns what is the item
    seed       crop and flip are functions of (seed, epoch, index), whatever the workers

    Raises FileNotFoundError or ValueError, which name the file and the clip. Clips finished later are not in it.
    """

    def __init__(self, folder: str | os.PathLike, split: str | None = None, frames: int | str = 1,
                 step: int | None = None, crop: int | None = None, flip: bool = False, truth: Sequence[str] = (),
                 rgb: bool = True, transform: Callable | None = None, seed: int = 0) -> None:
        if split not in ("train", "test", None):
            raise ValueError(f"split = {split!r}, must be 'train', 'test' or None")
        for name, value, other in (("frames", frames, "all"), ("step", step, None), ("crop", crop, None)):
            if value != other and (isinstance(value, str) or value is None or value < 1):
                raise ValueError(f"{name} = {value!r}, must be at least 1, or {other!r}")
        self.folder, self.frames, self.crop, self.flip = Path(folder), frames, crop, flip
        self.truth, self.rgb, self.transform, self.seed = tuple(truth), rgb, transform, seed
        output = _read_config(self.folder)["output"]
        self._written = tuple(output["truth"])
        for channel in self.truth:
            if TRUTH.get(channel) not in output["truth"]:
                raise ValueError(f"{folder}: its truth has no {channel!r}: output.truth is {output['truth']}")
        self.layout = output["layout"]
        self._manifests, index, _ = _index_manifests(self.folder, self.layout)
        if split:
            index = index[_is_test(index[:, 0], output["test_fraction"]) == (split == "test")]
        if not len(index):
            raise ValueError(f"{folder}: no clip of it is finished" + (f" that is in {split}" if split else ""))
        self._index = index
        lengths = index[:, 3] if frames == "all" else np.full(len(index), frames)
        if (index[:, 3] < lengths).any():
            raise ValueError(f"{folder}: clip {index[index[:, 3] < lengths][0, 0]}: has fewer than {frames} frames")
        self._step = step or (1 if frames == "all" else frames)
        self._ends = np.cumsum((index[:, 3] - lengths) // self._step + 1)  # items up to and with each clip
        # In shared memory, so that workers which live on see a new epoch.
        self._epoch = torch.zeros(1, dtype=torch.int64).share_memory_() if torch else np.zeros(1, np.int64)

    def set_epoch(self, epoch: int) -> None:
        """Gives the items of an epoch, from 0, their own crops and flips. Call it before each epoch."""
        self._epoch[0] = epoch

    def __len__(self) -> int:
        return int(self._ends[-1])

    def __getitem__(self, index: int) -> Any:
        row, first = self._place(index)
        line = self.line(index)
        count = int(self._index[row, 3]) if self.frames == "all" else self.frames
        turb = self._frames(line, "turb", first, count)
        rng = np.random.default_rng((self.seed, int(self._epoch[0]), index % len(self)))
        cut = _Cut(turb[0].shape, self.crop, self.flip, rng)
        item = [cut.apply(turb), cut.apply(self._frames(line, "clean", first, count))]
        if self.truth:
            item.append(cut.turn_shifts(cut.apply(self._truth(line, first, count)), self.truth))
        item = [array[0] if self.frames == 1 else array for array in item]
        item = [torch.from_numpy(array) if torch else array for array in item]
        return self.transform(*item) if self.transform else tuple(item)

    def line(self, index: int) -> dict[str, Any]:
        """The manifest's line of an item's clip: "clip", "drawn", "source" and what else docs/formats.md lists."""
        clip, manifest, offset, _ = (int(value) for value in self._index[self._place(index)[0]])
        path = self._manifests[manifest]
        try:
            with open(path, "rb") as file:
                file.seek(offset)
                line = json.loads(file.readline())
            if line["clip"] == clip:
                return line
        except (OSError, ValueError, KeyError, TypeError):
            pass
        raise ValueError(f"{path}: clip {clip}: its line is no longer where it was; make the data set anew")

    def place(self, index: int) -> tuple[int, int]:
        """The number of an item's clip, and the first of its frames in the clip."""
        row, first = self._place(index)
        return int(self._index[row, 0]), first

    def source(self, index: int) -> str:
        """What an item's clip was made of: the path of its picture or video, or the name of what is drawn."""
        source = self.line(index)["source"]
        return str(source.get("path", source.get("drawn")))

    def mask(self, index: int) -> np.ndarray | None:
        """How much of each pixel of an item's steady frames moving things cover: float32 in [0, 1], H x W or T x H x W.

        Of whole frames, without crop and flip. None: output.truth has no "mask".
        """
        masks = self._of_item(index, "mask")
        return masks and self._one_or_all(np.stack([_unit(mask)[:, :, 0] for mask in masks]))

    def flow(self, index: int) -> np.ndarray | None | list[np.ndarray | None]:
        """Where what is seen in a steady frame is in the next, px: H x W x 2 (u, v), or a list of them for windows.

        Of whole frames, without crop and flip. None in place of that of a clip's last frame, which has none, and where
        output.truth has no "flow".
        """
        flows = self._of_item(index, "flow")
        return flows and self._one_or_all(flows)

    def shake(self, index: int) -> np.ndarray | None:
        """The camera's shake (x, y) in an item's frames, px, float64: 2 or T x 2. steady(p) = shaken(p + s).

        Of frames that are not mirrored. None: output.truth has no "shake".
        """
        if "shake" not in self._written:
            return None
        row, first = self._place(index)
        line = self.line(index)
        count = int(self._index[row, 3]) if self.frames == "all" else self.frames
        files = [file for file in line["files"] if _kind(file, self.layout) == "shake"]
        if len(files) != 1:
            raise ValueError(f"{self.folder}: clip {line['clip']}: has {len(files)} files of its shake, must have one")
        data, where = self._bytes(files[0], line["clip"])
        try:
            shifts = np.array(json.loads(data)["shifts_px"], np.float64).reshape(-1, 2)[first:first + count]
        except (ValueError, KeyError, TypeError):
            raise ValueError(f"{where}: is no shake") from None
        if len(shifts) != count:
            raise ValueError(f"{where}: has no shift for frame {first + len(shifts)}")
        return self._one_or_all(shifts)

    def _one_or_all(self, frames: Any) -> Any:
        return frames[0] if self.frames == 1 else frames

    def _of_item(self, index: int, kind: str) -> list[np.ndarray | None] | None:
        if kind not in self._written:
            return None
        row, first = self._place(index)
        return self._frames(self.line(index), kind, first,
                            int(self._index[row, 3]) if self.frames == "all" else self.frames)

    def _truth(self, line: dict[str, Any], first: int, count: int) -> list[np.ndarray]:
        """The channels of self.truth, H x W x C float32 each frame."""
        planes: dict[str, list[np.ndarray]] = {}
        for kind in dict.fromkeys(TRUTH_FILES[TRUTH[channel]] for channel in self.truth):
            names = [channel for channel in self.truth if TRUTH_FILES[TRUTH[channel]] == kind]
            frames = self._frames(line, kind, first, count, names)
            if frames[-1] is None:  # of the last frame there is no flow
                shape = (frames[0] if count > 1 else self._frames(line, "turb", first, 1)[0]).shape[:2]
                frames[-1] = np.full((*shape, len(names)), np.nan, np.float32)
            for number, name in enumerate(names):
                planes[name] = [_unit(frame)[:, :, number] for frame in frames]
        return [np.stack([planes[channel][k] for channel in self.truth], axis=2) for k in range(count)]

    def _place(self, index: int) -> tuple[int, int]:
        """Row of an item's clip in the index, and the item's first frame."""
        if not -len(self) <= index < len(self):
            raise IndexError(f"item {index} of {len(self)}")
        index = int(index) % len(self)
        row = int(np.searchsorted(self._ends, index, side="right"))
        return row, (index - int(self._ends[row - 1] if row else 0)) * self._step

    def _frames(self, line: dict[str, Any], kind: str, first: int, count: int,
                channels: Sequence[str] = ("u", "v")) -> list[np.ndarray | None]:
        """Frames of a clip as they are in their files, H x W x C each. Flow of a clip's last frame: None."""
        files = [file for file in line["files"] if _kind(file, self.layout) == kind]
        alone = kind == "clean" and len(files) == 1  # the same for every frame
        chosen = files if alone else files[first:first + count]
        last = kind == "flow" and first + count == sum(_kind(file, self.layout) == "turb" for file in line["files"])
        if len(chosen) != (1 if alone else count - last):
            raise ValueError(f"{self.folder}: clip {line['clip']}: has no {kind} for its frame {first + len(chosen)}")
        channels = channels if kind in ("truth", "flow") else ()
        frames = [self._read(file, line["clip"], channels, self.rgb and kind != "mask") for file in chosen]
        return frames * count if alone else frames + [None] * last

    def _bytes(self, file: dict[str, Any], clip: int) -> tuple[bytes, str]:
        """A file's bytes, and how an error names it. Files are open only in here: workers share none."""
        path, name = self.folder / file["path"], file.get("member", file["path"])
        where = f"{path}: clip {clip}" + (f": {name}" if "member" in file else "")
        try:
            with open(path, "rb") as opened:
                opened.seek(file.get("offset", 0))
                data = opened.read(file.get("bytes", -1))
        except FileNotFoundError:
            raise FileNotFoundError(f"{where}: is not there, though the manifest names it") from None
        if len(data) != file.get("bytes", len(data)):
            raise ValueError(f"{where}: ends after {len(data)} of its {file['bytes']} bytes")
        return data, where

    def _read(self, file: dict[str, Any], clip: int, channels: Sequence[str], rgb: bool) -> np.ndarray:
        """A frame, or channels of the truth."""
        data, where = self._bytes(file, clip)
        if not file.get("member", file["path"]).endswith(".exr"):
            return _decode_png(data, where, rgb)
        if "member" not in file:
            return _read_exr(str(self.folder / file["path"]), where, channels, rgb)
        with tempfile.NamedTemporaryFile(suffix=".exr") as copy:  # OpenImageIO's Python reads files, not memory
            copy.write(data)
            copy.flush()
            return _read_exr(copy.name, where, channels, rgb)


class _Cut:
    """The part of its frames that an item shows: the same of turb, clean and truth."""

    def __init__(self, shape: Sequence[int], crop: int | None, flip: bool, rng: np.random.Generator) -> None:
        self.shape = tuple(shape[:2])
        self.size = self.shape if crop is None else (crop, crop)
        self.start = [int(rng.integers(max(whole - part, 0) + 1)) for whole, part in zip(self.shape, self.size)]
        self.flip = flip and rng.random() < 0.5

    def apply(self, frames: list[np.ndarray]) -> np.ndarray:
        """T frames H x W x C -> T x C x H x W float32; whole numbers are brought to [0, 1]."""
        if {frame.shape[:2] for frame in frames} != {self.shape}:
            raise ValueError(f"frames of one clip differ in size: {self.shape}, {frames[0].shape[:2]}")
        (y, x), (height, width) = self.start, self.size
        stack = np.stack([frame[y:y + height, x:x + width] for frame in frames])
        lack = (0, height - stack.shape[1]), (0, width - stack.shape[2])
        stack = np.pad(stack, ((0, 0), *lack, (0, 0)), mode="reflect")
        stack = stack[:, :, ::-1] if self.flip else stack
        values = np.array(stack.transpose(0, 3, 1, 2), np.float32, order="C")
        if np.issubdtype(stack.dtype, np.integer):
            values /= np.float32(np.iinfo(stack.dtype).max)
        return values

    def turn_shifts(self, truth: np.ndarray, channels: Sequence[str]) -> np.ndarray:
        """Where the image is mirrored, so are its shifts: dx and u left to right, dy and v top to bottom."""
        for number, channel in enumerate(channels):
            if channel in ("dx", "u"):
                truth[:, number] *= -self._signs(1)[::-1] if self.flip else self._signs(1)
            elif channel in ("dy", "v"):
                truth[:, number] *= self._signs(0)[:, None]
        return truth

    def _signs(self, axis: int) -> np.ndarray:
        """-1 where the reflection runs backwards, 1 elsewhere: it turns at the frame's far border, then at the near."""
        border = max(self.shape[axis] - 1, 1)
        position = self.start[axis] + np.arange(self.size[axis])
        return np.where(position % (2 * border) > border, -1, 1).astype(np.float32)


def _unit(frame: np.ndarray) -> np.ndarray:
    """float32; whole numbers are brought to [0, 1]."""
    if np.issubdtype(frame.dtype, np.integer):
        return frame.astype(np.float32) / np.float32(np.iinfo(frame.dtype).max)
    return frame


def _decode_png(data: bytes, where: str, rgb: bool) -> np.ndarray:
    """H x W x C, uint8 or uint16; channels R, G, B, or grey."""
    frame = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED) if data else None
    if frame is None:
        raise ValueError(f"{where}: is no whole PNG")
    if frame.ndim == 3:
        return frame[:, :, ::-1]  # OpenCV's are B, G, R
    return np.repeat(frame[:, :, None], 3 if rgb else 1, axis=2)


def _read_exr(path: str, where: str, channels: Sequence[str], rgb: bool) -> np.ndarray:
    """H x W x C float32: the channels asked for, or all."""
    import OpenImageIO as oiio  # only EXR needs it
    oiio.attribute("threads", 1)  # threads of its own don't survive the fork of a worker, which would wait for them
    oiio.attribute("exr_threads", -1)
    file = oiio.ImageInput.open(path)
    pixels = file.read_image("float") if file else None
    if pixels is None:
        raise ValueError(f"{where}: is no whole EXR: {file.geterror() if file else oiio.geterror()}")
    names = list(file.spec().channelnames)
    if not set(channels) <= set(names):
        raise ValueError(f"{where}: has the channels {', '.join(names)}, must have {', '.join(channels)}")
    if channels:
        return pixels[:, :, [names.index(channel) for channel in channels]]
    return np.repeat(pixels, 3, axis=2) if rgb and len(names) == 1 else pixels


def _read_config(folder: Path) -> dict[str, Any]:
    try:
        return json.loads((folder / "dataset.json").read_bytes())["config"]
    except FileNotFoundError:
        raise FileNotFoundError(f"{folder}: holds no data set (no dataset.json)") from None


def _kind(file: dict[str, Any], layout: str) -> str | None:
    """"turb", "clean", "truth", "mask", "flow", "shake", or None for what is none of them."""
    if layout == "webdataset":
        return KINDS.get(file["member"].split(".")[1])
    if layout == "sequence" and file["path"].endswith("/shake.json"):
        return "shake"
    return KINDS.get(file["path"].split("/")[-3 if layout == "basicsr" else -2])


def _index_manifests(folder: Path, layout: str) -> tuple[list[Path], np.ndarray, int]:
    """The manifests; a row (clip, its manifest, offset of its line there, frames) a finished clip; how many failed.

    A manifest's last line of a clip counts, and of several manifests' one that says "done".
    """
    manifests = sorted(folder.glob("manifest.jsonl")) + sorted(folder.glob("manifest.*-of-*.jsonl"))
    if not manifests:
        raise FileNotFoundError(f"{folder}: holds no manifest.jsonl: nothing of it is finished")
    rows: dict[int, tuple[int, ...] | None] = {}
    for number, path in enumerate(manifests):
        found: dict[int, tuple[int, ...] | None] = {}
        for offset, line in _manifest_lines(path):
            frames = sum(_kind(file, layout) == "turb" for file in line.get("files", ()))
            found[line["clip"]] = (line["clip"], number, offset, frames) if line["status"] == "done" else None
        rows.update((clip, row) for clip, row in found.items() if row or clip not in rows)
    done = sorted(row for row in rows.values() if row)
    return manifests, np.array(done, np.int64).reshape(-1, 4), len(rows) - len(done)


def _manifest_lines(path: Path) -> Iterator[tuple[int, dict[str, Any]]]:
    """Offset and content of each line. A torn one is not written yet, or never was."""
    offset = 0
    with open(path, "rb") as file:
        for number, text in enumerate(file, 1):
            if b"\0" in text:  # a power cut left it: nothing from there on is written
                return
            try:
                line = json.loads(text)
            except ValueError:
                if file.read(1):
                    raise ValueError(f"{path}:{number}: is damaged: no JSON") from None
                return
            if text.endswith(b"\n"):
                yield offset, line
            offset += len(text)


def _is_test(clips: np.ndarray, fraction: float) -> np.ndarray:
    """Which clips are in the test half: the rule of docs/formats.md. The millionth undoes rounding."""
    return np.floor((clips + 1) * fraction + 1e-6) > np.floor(clips * fraction + 1e-6)


def describe(folder: str | os.PathLike) -> None:
    """Prints what is in a data set's folder, and the shape and range of its first clip."""
    config = _read_config(Path(folder))
    output = config["output"]
    _, index, failed = _index_manifests(Path(folder), output["layout"])
    test = _is_test(index[:, 0], output["test_fraction"])
    print(f"{output['layout']}, {output['format']} of {output['bits']} bits")
    print(f"{len(index)} of {config['clips']} clips, {failed} failed; frames: {index[~test, 3].sum()} train, "
          f"{index[test, 3].sum()} test")
    channels = [channel for channel, key in TRUTH.items() if key in output["truth"]]
    item = ShimmerDataset(folder, frames="all", truth=channels)[0] if len(index) else ()
    for name, frames in zip(("turb", "clean", "truth"), item):
        print(f"{name:5} {' x '.join(map(str, frames.shape))}, {np.nanmin(frames):.3f} to {np.nanmax(frames):.3f}")


if __name__ == "__main__":
    try:
        describe(*sys.argv[1:])
    except (ImportError, OSError, TypeError, ValueError) as error:
        sys.exit(f"shimmer_dataset.py: {error}")
