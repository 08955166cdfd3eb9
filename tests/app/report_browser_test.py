#!/usr/bin/python3
"""Opens a data set's report.html in headless Chromium, as a reader does, and looks at it.

  report_browser_test.py --program build/release/bin/shimmer
  report_browser_test.py --pictures FOLDER --report DIR/report.html    keeps what it sees

At 1280 and 400 px width, in light and dark: nothing is wider than the window, the contact sheet decodes, no text
leaves its chart, the console stays empty, and the screenshot is a picture of something.
"""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

try:
    import numpy
    import OpenImageIO as oiio
except ImportError:
    numpy = oiio = None

SKIPPED = 77  # ctest's SKIP_RETURN_CODE
SECONDS = 120
WIDTHS_PX = (1280, 400)
FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--hide-scrollbars",
         "--disable-background-networking", "--disable-component-update", "--disable-sync", "--enable-logging=stderr")

CONFIG = {
    "seed": 3, "clips": 12, "frames": 2, "size": {"choice": [[64, 48], [48, 64]]},
    "source": {"images": "pictures", "scale": {"uniform": [0.5, 1]}},
    "tilt": {"strength_px": {"log_uniform": [0.5, 10]}, "octaves": {"uniform": [6, 8]},
             "kernel": {"choice": [0.5, 0.6]}},
    "blur": {"max_sigma_px": {"normal": [2, 1], "clip": [0.5, 6]}}}

# Added to a copy of the page: what the page itself, which has no script, is measured with.
MEASURE = """<script>
addEventListener("load", () => {
  const root = document.documentElement, wide = [], cut = [];
  const scrolls = node => node && (/auto|scroll/.test(getComputedStyle(node).overflowX) || scrolls(node.parentElement));
  for (const node of document.body.querySelectorAll("*"))
    if (node.getBoundingClientRect().right > innerWidth + 1 && !scrolls(node.parentElement) && !node.closest("svg"))
      wide.push(node.outerHTML.slice(0, 80));
  for (const text of document.querySelectorAll("svg text")) {
    const box = text.getBoundingClientRect(), chart = text.ownerSVGElement.getBoundingClientRect();
    if (box.left < chart.left - 1 || box.right > chart.right + 1 || box.top < chart.top - 1 || box.bottom > chart.bottom + 1)
      cut.push(text.textContent);
  }
  parent.postMessage(JSON.stringify({
    width: innerWidth, scroll_width: root.scrollWidth, height: root.scrollHeight, wide, cut,
    dark: matchMedia("(prefers-color-scheme: dark)").matches,
    images: [...document.images].map(image => [image.complete, image.naturalWidth, image.naturalHeight]),
    charts: document.querySelectorAll("figure.chart").length}), "*");
});
</script>"""

# Chromium's windows are no narrower than 500 px, frames within them are.
FRAME = """<!DOCTYPE html><body style="margin:0"><iframe src="{page}" style="width:{width}px;height:{height}px;border:0">
</iframe><pre id="seen"></pre><script>
addEventListener("message", event => {{ const seen = document.getElementById("seen");
  seen.hidden = true; seen.textContent = event.data; }});
</script></body>"""


class Browser:
    def __init__(self, chromium, folder, dark):
        self.chromium, self.folder = chromium, folder
        self.dark = ["--blink-settings=preferredColorScheme=0"] if dark else []
        self.faults = []

    def run(self, page, window, *more):
        profile = tempfile.mkdtemp(dir=self.folder, prefix="profile-")
        done = subprocess.run(
            [self.chromium, *FLAGS, *self.dark, f"--user-data-dir={profile}", f"--window-size={window[0]},{window[1]}",
             "--virtual-time-budget=10000", *more, page.as_uri()],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=SECONDS)
        if done.returncode != 0:
            sys.exit(f"chromium ends with {done.returncode}:\n{done.stderr}")
        self.faults += [line for line in done.stderr.splitlines() if ":CONSOLE" in line]
        return done.stdout

    def frame(self, page, width, height):
        path = self.folder / f"frame-{width}.html"
        path.write_text(FRAME.format(page=page.name, width=width, height=height))
        return path

    def measure(self, page, width):
        dom = self.run(self.frame(page, width, 900), (max(width, 500), 900), "--dump-dom")
        return json.loads(re.search(r'<pre id="seen"[^>]*>(.*?)</pre>', dom, re.S).group(1).replace("&lt;", "<")
                          .replace("&gt;", ">").replace("&amp;", "&"))

    def screenshot(self, page, width, height, path):
        self.run(self.frame(page, width, height), (max(width, 500), height), f"--screenshot={path}")
        return path


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


def faults_of(seen, width, dark):
    """What is wrong with a page as Browser.measure saw it."""
    if seen["width"] != width or seen["dark"] != dark:
        yield f"not what was asked for: {seen['width']} px, dark {seen['dark']}"
    if seen["scroll_width"] > width or seen["wide"]:
        yield f"wider than the window: {seen['scroll_width']} px, {seen['wide']}"
    if seen["cut"]:
        yield f"texts that leave their chart: {seen['cut']}"
    if len(seen["images"]) != 1 or not all(complete and w > 100 and h > 100 for complete, w, h in seen["images"]):
        yield f"the contact sheet is not shown: {seen['images']}"
    if seen["charts"] < 3:
        yield f"{seen['charts']} charts"


def look(report, chromium, folder, pictures):
    """Returns what is wrong, a line each."""
    text, faults = report.read_text(encoding="utf-8"), []
    page = folder / "measured.html"
    page.write_text(text.replace("</body>", MEASURE + "</body>"), encoding="utf-8")
    for dark in (False, True):
        browser = Browser(chromium, folder, dark)
        for width in WIDTHS_PX:
            name = f"{'dark' if dark else 'light'}-{width}"
            seen = browser.measure(page, width)
            screenshot = browser.screenshot(page, width, seen["height"], pictures / f"{name}.png")
            faults += [f"{name}: {fault}" for fault in (*faults_of(seen, width, dark), *blank_parts(screenshot, dark))]
        faults += browser.faults
    # As it is, opened from disk.
    browser = Browser(chromium, folder, dark=False)
    if "<h1>" not in browser.run(report, (1280, 900), "--dump-dom"):
        faults.append("no title in the page as it is")
    return faults + browser.faults


def unseen_faults(report, chromium, folder):
    """What a spoiled page would have to be found guilty of, and is not."""
    page = folder / "spoiled.html"
    text = report.read_text(encoding="utf-8").replace("base64,", "base64,AAAA").replace(">clips</text>", ">clips of all of them</text>")
    page.write_text(text.replace("</body>", '<p style="width:2000px">wide<script>console.error("loud")</script>' + MEASURE
                                 + "</body>"), encoding="utf-8")
    browser = Browser(chromium, folder, dark=False)
    found = "\n".join([*faults_of(browser.measure(page, 400), 400, dark=False), *browser.faults])
    return [f"a spoiled page is taken for good: not '{part}'"
            for part in ("wider than the window", "leave their chart", "is not shown", "loud") if part not in found]


def blank_parts(screenshot, dark):
    pixels = oiio.ImageBuf(str(screenshot)).get_pixels(oiio.UINT8)[:, :, :3].astype(int)
    if (numpy.median(pixels) < 128) != dark:
        yield f"the page's colour is {numpy.median(pixels)}"
    colours = len(numpy.unique(pixels @ (1 << 16, 1 << 8, 1)))
    if colours < 500:  # text alone has some dozens, the contact sheet thousands
        yield f"only {colours} colours"
    for number, part in enumerate(numpy.array_split(pixels, 4)):
        if part.std() < 2:
            yield f"quarter {number} is blank"


def main():
    arguments = argparse.ArgumentParser(description="Looks at a report in headless Chromium.")
    arguments.add_argument("--program", type=pathlib.Path, help="makes a small set to look at")
    arguments.add_argument("--report", type=pathlib.Path, help="looks at this page instead")
    arguments.add_argument("--pictures", type=pathlib.Path, help="folder to keep the screenshots in")
    given = arguments.parse_args()
    chromium = shutil.which("chromium")
    if not chromium or oiio is None:
        print("skipped: needs chromium, python3-openimageio and python3-numpy (scripts/setup.sh --all)")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory(prefix="shimmer-report-") as name:
        folder = pathlib.Path(name)
        report = given.report or make_report(given.program.resolve(), folder)
        faults = look(report.resolve(), chromium, folder, (given.pictures or folder).resolve())
        faults += unseen_faults(report, chromium, folder)
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
