#!/usr/bin/python3
"""Opens a data set's report.html in headless Chromium, as a reader does, and looks at it.

  report_browser_test.py --program build/release/bin/shimmer
  report_browser_test.py --pictures FOLDER --report DIR/report.html    keeps what it sees

Beside what ../browser/page.py asks of any page: the contact sheet is there, and charts.
"""

import json
import pathlib
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "browser"))
import page

CONFIG = {
    "seed": 3, "clips": 12, "frames": 2, "size": {"choice": [[64, 48], [48, 64]]},
    "source": {"images": "pictures", "scale": {"uniform": [0.5, 1]}},
    "tilt": {"strength_px": {"log_uniform": [0.5, 10]}, "octaves": {"uniform": [6, 8]},
             "kernel": {"choice": [0.5, 0.6]}},
    "blur": {"max_sigma_px": {"normal": [2, 1], "clip": [0.5, 6]}}}


def make_report(program, folder):
    """A small set with drawn values of every kind and a source that is no picture."""
    pictures = folder / "pictures"
    pictures.mkdir()
    drawn = {"clips": 2, "frames": 1, "size": [160, 120], "source": {"drawn": {"choice": ["chart", "text"]}}}
    (folder / "drawn.json").write_text(json.dumps(drawn))
    subprocess.run([program, "generate", folder / "drawn.json", "--out", folder / "drawn", "--quiet"], check=True)
    for clip in range(2):
        shutil.copy(folder / f"drawn/clips/{clip:06}/clean/0000.png", pictures / f"picture {clip} & <more>.png")
    (pictures / ("very_" * 40 + "long.png")).write_text("not a picture")
    (folder / "config.json").write_text(json.dumps(CONFIG))
    failing = subprocess.run([program, "generate", folder / "config.json", "--out", folder / "set", "--quiet"],
                             capture_output=True)
    assert failing.returncode == 1, failing
    done = subprocess.run([program, "report", folder / "set"], check=True, capture_output=True, text=True)
    return pathlib.Path(done.stdout.strip())


def own_faults(seen):
    if len(seen["images"]) != 1 or not all(complete and w > 100 and h > 100 for complete, w, h in seen["images"]):
        yield f"the contact sheet is not shown: {seen['images']}"
    if seen["charts"] < 3:
        yield f"{seen['charts']} charts"


def unseen_faults(report, chromium, folder):
    """What a spoiled page would have to be found guilty of, and is not."""
    text = report.read_text(encoding="utf-8").replace("base64,", "base64,AAAA").replace(">clips</text>", ">clips of all of them</text>")
    spoiled = page.with_scripts(text, folder / "spoiled.html",
                                '<p style="width:2000px">wide<script>console.error("loud")</script>')
    browser = page.Browser(chromium, folder)
    seen = browser.measure(spoiled, 400)
    found = "\n".join([*page.faults_of(seen, 400, dark=False), *own_faults(seen), *browser.faults])
    return [f"a spoiled page is taken for good: not '{part}'"
            for part in ("wider than the window", "leave their chart", "is not shown", "loud") if part not in found]


def look_at(report, chromium, folder, pictures):
    return page.look(report, chromium, folder, pictures, own_faults) + unseen_faults(report, chromium, folder)


if __name__ == "__main__":
    page.main("shimmer, which makes a small set to look at", make_report, look_at)
