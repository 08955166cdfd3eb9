#include "restore/app/evaluation/report_script.h"

namespace shimmer::restore::app {

const char* const kReportScript = R"js(
"use strict";
document.documentElement.classList.add("scripted");

// Tables: a click on a column's name sorts by it, the next one the other way round. What has no number comes
// last both ways.
const words = new Intl.Collator("en", {numeric: true});

function compare(a, b, numbers) {
  if (!numbers) return words.compare(a.textContent, b.textContent);
  return Number(a.dataset.value) - Number(b.dataset.value) || 0;  // inf less inf is none
}

function sortBy(table, column, downwards) {
  const head = table.tHead.rows[0].cells[column], body = table.tBodies[0];
  const numbers = head.classList.contains("number"), rows = [...body.rows];
  const absent = row => numbers && row.cells[column].dataset.value === undefined;
  const there = rows.filter(row => !absent(row));
  there.sort((a, b) => (downwards ? -1 : 1) * compare(a.cells[column], b.cells[column], numbers));
  body.append(...there, ...rows.filter(absent));
}

for (const table of document.querySelectorAll(".table table")) {
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => head.querySelector("button").addEventListener("click", () => {
    const downwards = head.getAttribute("aria-sort") === "ascending";
    for (const other of heads) other.setAttribute("aria-sort", "none");
    head.setAttribute("aria-sort", downwards ? "descending" : "ascending");
    sortBy(table, column, downwards);
  }));
}

// Two pictures on both sides of a line, which keys move through the range that has the focus, and pointers by
// where they are.
for (const compared of document.querySelectorAll(".compared")) {
  const slider = compared.querySelector(".slider"), range = slider.querySelector("input");
  const images = [...slider.querySelectorAll(".after")], buttons = [...compared.querySelectorAll(".views button")];
  const show = () => {
    for (const image of images) image.style.clipPath = `inset(0 0 0 ${range.value}%)`;
    slider.querySelector(".divider").style.left = `${range.value}%`;
  };
  const follow = event => {
    const box = slider.getBoundingClientRect();
    range.value = 100 * (event.clientX - box.left) / box.width;
    show();
  };
  range.addEventListener("input", show);
  slider.addEventListener("pointerdown", event => {
    if (event.button !== 0) return;
    event.preventDefault();  // no selecting
    range.focus({preventScroll: true});
    follow(event);
    // On the window, so that the line follows beyond the picture's edge.
    const end = () => {
      removeEventListener("pointermove", follow);
      for (const last of ["pointerup", "pointercancel"]) removeEventListener(last, end);
    };
    addEventListener("pointermove", follow);
    for (const last of ["pointerup", "pointercancel"]) addEventListener(last, end);
  });
  for (const button of buttons) button.addEventListener("click", () => {
    for (const other of buttons) other.setAttribute("aria-pressed", other === button);
    for (const image of images) image.hidden = image.dataset.view !== button.dataset.view;
    compared.querySelector("[data-side]").textContent = button.textContent;
  });
  show();
}
)js";

}  // namespace shimmer::restore::app
