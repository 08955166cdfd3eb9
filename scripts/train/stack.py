#!/usr/bin/python3
"""Makes of a data set what restoration hands to the sharpening network: steadied, averaged and blended frames.

    stack.py DATASET --out FOLDER [--clips N] [--program unshimmer]

OUT/000123/0000.png ... are the frames of clip 123, by `unshimmer restore --no-sharpen`. Clips that are there are left
as they are, so that it goes on where it stopped. The data set's layout is `sequence`.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

from shimmer_dataset import ShimmerDataset


def stack(dataset: Path, out: Path, clips: int | None, program: str) -> int:
    """Returns how many clips are there. One that can't be restored is named and left out."""
    sequence = ShimmerDataset(dataset, frames="all")
    if sequence.layout != "sequence":
        raise ValueError(f"{dataset}: output.layout is {sequence.layout}, must be sequence: the others have no folders "
                         "of clips")
    out.mkdir(parents=True, exist_ok=True)
    done = 0
    for item in range(len(sequence))[:clips]:
        line = sequence.line(item)
        folder = dataset / Path(line["files"][0]["path"]).parents[1]
        stacked = out / f"{line['clip']:06d}"
        if not stacked.is_dir():
            run = subprocess.run([program, "restore", folder, "--no-sharpen", "--out", stacked, "--quiet"],
                                 stderr=subprocess.PIPE, text=True)
            if run.returncode:
                print(f"stack.py: {folder}: {run.stderr.strip()}", file=sys.stderr)
                continue
        done += 1
    if not done:
        raise ValueError(f"{dataset}: none of its clips could be restored")
    return done


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--clips", type=int, help="of the first so many only")
    parser.add_argument("--program", default="unshimmer")
    arguments = parser.parse_args()
    try:
        print(f"{stack(arguments.dataset, arguments.out, arguments.clips, arguments.program)} clips")
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f"stack.py: {error}")
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
