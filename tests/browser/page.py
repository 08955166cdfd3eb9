"""What tests of our pages share: headless Chromium, as a reader has it, and what is wrong with any page.

At 1280 and 400 px width, in light and dark: nothing is wider than the window, no text leaves its chart, pictures decode,
the console stays empty, and the screenshot is a picture of something.
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

# Added to a copy of the page: what it is measured with. A page's own test may define act() before, which does something
# with the page and gives what came of it.
MEASURE = """<script>
addEventListener("load", () => {
  const root = document.documentElement, wide = [], cut = [];
  const acted = typeof act === "function" ? act() : null;
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
    width: innerWidth, scroll_width: root.scrollWidth, height: root.scrollHeight, wide, cut, acted,
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
    def __init__(self, chromium, folder, dark=False):
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
        seen = re.search(r'<pre id="seen"[^>]*>(.*?)</pre>', dom, re.S).group(1)
        if not seen:
            sys.exit(f"nothing is measured of {page}:\n" + "\n".join(self.faults))
        return json.loads(seen.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"))

    def screenshot(self, page, width, height, path):
        self.run(self.frame(page, width, height), (max(width, 500), height), f"--screenshot={path}")
        return path


def with_scripts(text, path, more=""):
    """A copy of a page (its text) at a path, to be measured."""
    path.write_text(text.replace("</body>", more + MEASURE + "</body>"), encoding="utf-8")
    return path


def faults_of(seen, width, dark):
    """What is wrong with a page as Browser.measure saw it."""
    if seen["width"] != width or seen["dark"] != dark:
        yield f"not what was asked for: {seen['width']} px, dark {seen['dark']}"
    if seen["scroll_width"] > width or seen["wide"]:
        yield f"wider than the window: {seen['scroll_width']} px, {seen['wide']}"
    if seen["cut"]:
        yield f"texts that leave their chart: {seen['cut']}"
    undecoded = [image for image in seen["images"] if not image[0] or not image[1] or not image[2]]
    if undecoded:
        yield f"pictures are not shown: {undecoded}"


def blank_parts(screenshot, dark):
    pixels = oiio.ImageBuf(str(screenshot)).get_pixels(oiio.UINT8)[:, :, :3].astype(int)
    if (numpy.median(pixels) < 128) != dark:
        yield f"the page's colour is {numpy.median(pixels)}"
    colours = len(numpy.unique(pixels @ (1 << 16, 1 << 8, 1)))
    if colours < 500:  # text alone has some dozens, pictures thousands
        yield f"only {colours} colours"
    for number, part in enumerate(numpy.array_split(pixels, 4)):
        if part.std() < 2:
            yield f"quarter {number} is blank"


def look(report, chromium, folder, pictures, own_faults):
    """What is wrong, a line each. own_faults: of what Browser.measure saw, which this page alone may have."""
    page, faults = with_scripts(report.read_text(encoding="utf-8"), folder / "measured.html"), []
    for dark in (False, True):
        browser = Browser(chromium, folder, dark)
        for width in WIDTHS_PX:
            name = f"{'dark' if dark else 'light'}-{width}"
            seen = browser.measure(page, width)
            screenshot = browser.screenshot(page, width, seen["height"], pictures / f"{name}.png")
            faults += [f"{name}: {fault}" for fault in
                       (*faults_of(seen, width, dark), *own_faults(seen), *blank_parts(screenshot, dark))]
        faults += browser.faults
    # As it is, opened from disk.
    browser = Browser(chromium, folder)
    if "<h1>" not in browser.run(report, (1280, 900), "--dump-dom"):
        faults.append("no title in the page as it is")
    return faults + browser.faults


def main(program, make_report, look_at):
    """Of a test: look_at(report, chromium, folder, pictures) gives what is wrong with a page, a line each.

    program: what the option is for that names what make_report(program, folder) runs.
    """
    arguments = argparse.ArgumentParser(description="Looks at a page in headless Chromium.")
    arguments.add_argument("--program", type=pathlib.Path, help=program)
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
        faults = look_at(report.resolve(), chromium, folder, (given.pictures or folder).resolve())
    if faults:
        sys.exit("\n".join(faults))
