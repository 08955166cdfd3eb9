#!/usr/bin/python3
"""Opens the page of an evaluation in headless Chromium, clicks on what it has to click, and looks at it.

  evaluation_browser_test.py --program build/release/bin/make_evaluation_page
  evaluation_browser_test.py --pictures FOLDER --report REPORT/report.html    keeps what it sees

Beside what ../../browser/page.py asks of any page: tables sort both ways, the line over a picture moves by keys and by
the pointer, and the buttons choose what is on its right.
"""

import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "browser"))
import page

# As a reader: clicks, keys and a pointer. Gives what was there to see after each.
ACT = """<script>
function act() {
  const table = document.querySelector("#clips table");
  const head = [...table.tHead.rows[0].cells].find(cell => cell.dataset.key === "ssim");
  const column = head.cellIndex, order = () => [...table.tBodies[0].rows].map(row => row.cells[column].dataset.value ?? null);
  const names = () => [...table.tBodies[0].rows].map(row => row.cells[0].textContent);
  const sorted = {by_name: [], by_ssim: [], first: names()};
  for (let click = 0; click < 2; ++click) {
    head.querySelector("button").click();
    sorted.by_ssim.push([head.getAttribute("aria-sort"), order()]);
  }
  for (let click = 0; click < 2; ++click) {
    table.tHead.rows[0].cells[0].querySelector("button").click();
    sorted.by_name.push(names());
  }
  const compared = document.querySelector(".compared"), slider = compared.querySelector(".slider");
  const range = slider.querySelector("input"), shown = () => slider.querySelector(".after:not([hidden])");
  const clip = () => getComputedStyle(shown()).clipPath, clips = [clip()];
  range.value = 20;
  range.dispatchEvent(new Event("input"));
  clips.push(clip());
  const box = slider.getBoundingClientRect();
  const pointer = (kind, part) => slider.dispatchEvent(new PointerEvent(
    kind, {bubbles: true, cancelable: true, button: 0, buttons: 1, clientX: box.left + part * box.width, clientY: box.top + 9}));
  pointer("pointerdown", 0.7);
  clips.push(clip());
  pointer("pointermove", 0.9);
  clips.push(clip());
  pointer("pointerup", 0.9);
  pointer("pointermove", 0.1);
  clips.push(clip());
  const views = [[shown().dataset.view, shown().offsetWidth > 0]];
  for (const view of ["truth", "mask", "result"]) {
    const button = compared.querySelector(`button[data-view=${view}]`);
    button.click();
    views.push([shown().dataset.view, shown().offsetWidth > 0, button.getAttribute("aria-pressed"), clip()]);
  }
  return {sorted, clips, views, focused: document.activeElement === range,
          links: [...document.querySelectorAll("#clips a")].map(link => !!document.querySelector(link.getAttribute("href")))};
}
</script>"""

# Where scripts are off (this one is added later): whether the restored frame is all to be seen, and what is there to click.
LOOK = """<script>
function act() {
  const shown = document.querySelector(".after:not([hidden])");
  return {whole: shown.dataset.view === "result" && getComputedStyle(shown).clipPath === "none" && shown.offsetWidth > 100,
          works: [...document.querySelectorAll(".slider input, .views button, .divider")]
            .filter(node => node.offsetWidth > 0).map(node => node.outerHTML)};
}
</script>"""


PROGRAMS = []  # the folder of shimmer and unshimmer, where a page is made

CONFIG = {"seed": 2, "clips": 3, "frames": 6, "size": [96, 80], "source": {"drawn": "bricks"},
          "tilt": {"strength_px": {"choice": [2, 4]}, "base_frequency": 0.06}, "blur": {"max_sigma_px": 1},
          "objects": [{"drawn": "box", "height_px": 24, "hue": 0.6,
                       "motion": {"start_x": 0.3, "start_y": 0.6, "speed_px": 4}}],
          "output": {"truth": ["mask", "shake"]}}


def make_report(program, folder):
    """A page to look at: of 40 clips, with pictures, and with every odd value that there can be."""
    PROGRAMS.append(program.parent)
    subprocess.run([program, folder], check=True)
    return folder / "report.html"


def evaluated_faults(chromium, folder):
    """What is wrong with a page that the program itself makes, of clips that it made."""
    if not PROGRAMS:
        return []
    (folder / "set.json").write_text(json.dumps(CONFIG))
    subprocess.run([PROGRAMS[0] / "shimmer", "generate", folder / "set.json", "--out", folder / "set", "--quiet"], check=True)
    subprocess.run([PROGRAMS[0] / "unshimmer", "evaluate", folder / "set", "--out", folder / "evaluated", "--baselines",
                    "--real", folder / "set/clips/000000/turb", "--quiet"], check=True, stdout=subprocess.DEVNULL)
    return [f"evaluated: {fault}" for fault in click_faults(folder / "evaluated/report.html", chromium, folder)]


def own_faults(seen):
    if len(seen["images"]) < 10:
        yield f"only {len(seen['images'])} pictures"
    if seen["charts"] < 2:
        yield f"{seen['charts']} charts"


def order_faults(name, column, downwards):
    """Of a column of numbers as texts, None where there is none."""
    numbers = [float(value.replace("Infinity", "inf")) for value in column if value is not None]
    if None in column[:len(numbers)]:
        yield f"{name}: rows without a number are not the last"
    if numbers != sorted(numbers, reverse=downwards) or len(set(numbers)) < 2:
        yield f"{name}: not in order: {numbers}"


def acted_faults(acted):
    """What is wrong with what came of ACT."""
    (up, rising), (down, falling) = acted["sorted"]["by_ssim"]
    if (up, down) != ("ascending", "descending"):
        yield f"sorted is said to be {up}, then {down}"
    yield from order_faults("first click", rising, downwards=False)
    yield from order_faults("second click", falling, downwards=True)
    by_name, by_name_down = acted["sorted"]["by_name"]
    if by_name != by_name_down[::-1] or sorted(by_name) != sorted(acted["sorted"]["first"]):
        yield "names are not sorted both ways, or rows are lost"
    if acted["clips"] != [f"inset(0px 0px 0px {percent}%)" for percent in (50, 20, 70, 90, 90)]:
        yield f"the line does not move: {acted['clips']}"
    if [view[0] for view in acted["views"]] != ["result", "truth", "mask", "result"] or \
            not all(view[1] for view in acted["views"]) or any(view[2:] != ["true", "inset(0px 0px 0px 90%)"]
                                                               for view in acted["views"][1:]):
        yield f"the buttons do not choose the picture: {acted['views']}"
    if not acted["focused"]:
        yield "the pointer does not give the line the keys"
    if not acted["links"] or not all(acted["links"]):
        yield f"links that lead nowhere: {acted['links']}"


def click_faults(report, chromium, folder):
    text, faults = report.read_text(encoding="utf-8"), []
    clicked = page.with_scripts(text, folder / "clicked.html", ACT)
    browser = page.Browser(chromium, folder)
    for width in page.WIDTHS_PX:
        seen = browser.measure(clicked, width)
        faults += [f"clicked, {width}: {fault}"
                   for fault in (*page.faults_of(seen, width, dark=False), *acted_faults(seen["acted"]))]
    return faults + browser.faults


def scriptless_faults(report, chromium, folder):
    """What is wrong with the page where scripts are off: the result has to be seen, and nothing that does not work."""
    text = report.read_text(encoding="utf-8")
    start, end = text.rindex("<script>"), text.rindex("</script>")
    browser = page.Browser(chromium, folder)
    plain = page.with_scripts(text[:start] + text[end + len("</script>"):], folder / "plain.html", LOOK)
    seen = browser.measure(plain, 400)
    faults = [*page.faults_of(seen, 400, dark=False), *browser.faults]
    if seen["acted"] != {"whole": True, "works": []}:
        faults.append(f"{seen['acted']}")
    return [f"without script: {fault}" for fault in faults]


def unseen_faults(report, chromium, folder):
    """What spoiled pages would have to be found guilty of, and are not."""
    text = report.read_text(encoding="utf-8")
    for part in ("body.append(", "clipPath = `inset(0 0 0 ${", "image.hidden =", "true tilt RMS, px</text>", "base64,"):
        if part not in text:
            return [f"nothing to spoil: the page has no '{part}'"]
    looks = text.replace("base64,", "base64,AAAA").replace("true tilt RMS, px</text>", "tilt" * 60 + "</text>")
    works = text.replace("body.append(", "void (").replace("clipPath = `inset(0 0 0 ${", "clipPath = `inset(0 0 1% ${") \
                .replace("image.hidden =", "void")
    browser = page.Browser(chromium, folder)
    spoiled = page.with_scripts(looks, folder / "spoiled.html",
                                '<p style="width:2000px">wide<script>console.error("loud")</script>')
    found = [*page.faults_of(browser.measure(spoiled, 400), 400, dark=False)]
    spoiled = page.with_scripts(works, folder / "spoiled.html", ACT)
    found += acted_faults(browser.measure(spoiled, 1280)["acted"])
    found = "\n".join([*found, *browser.faults])
    return [f"a spoiled page is taken for good: not '{part}'"
            for part in ("wider than the window", "leave their chart", "are not shown", "loud", "not in order",
                         "does not move", "do not choose") if part not in found]


def look_at(report, chromium, folder, pictures):
    return page.look(report, chromium, folder, pictures, own_faults) + click_faults(report, chromium, folder) + \
        scriptless_faults(report, chromium, folder) + evaluated_faults(chromium, folder) + \
        unseen_faults(report, chromium, folder)


if __name__ == "__main__":
    page.main("make_evaluation_page, which makes a page to look at", make_report, look_at)
