#include "restore/app/evaluation/report_look.h"

namespace shimmer::restore::app {

const char* const kReportLook = R"css(
:root { --v0: #1f5fa8; --v1: #b4451f; --v2: #2f7d3b; --v3: #7a4bb0; --v4: #9a7400; --v5: #b03a78; --v6: #1c8087;
  --v7: #6b6f73; }
@media (prefers-color-scheme: dark) { :root { --v0: #7db2f0; --v1: #f0926b; --v2: #7fcf8a; --v3: #bb9bec;
  --v4: #dcbb4c; --v5: #ee8fbd; --v6: #65c7cd; --v7: #a9afb3; } }
h3 { margin: 24px 0 8px; font-size: 15px; }
small { color: var(--quiet); font-size: 12px; font-weight: 400; }
.tile { min-width: 0; overflow-wrap: anywhere; }
.error { min-width: 26ch; color: var(--bad); }

.table { overflow-x: auto; margin-bottom: 16px; }
.table table { width: auto; min-width: 100%; font-size: 14px; }
.table th, .table td { padding: 5px 8px; vertical-align: baseline; }
.table thead th { padding: 0; vertical-align: bottom; }
.table th[scope=row], .table td:not(.number) { min-width: 9ch; max-width: 36ch; overflow-wrap: break-word;
  unicode-bidi: isolate; }
.table th:first-child { position: sticky; left: 0; padding-left: 0; background: var(--page); z-index: 1; }
.table th[scope=row] { font-weight: 400; }
.table .number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.table thead button { width: 100%; padding: 5px 8px; border: 0; background: none; color: inherit; font: inherit;
  font-weight: 600; text-align: inherit; white-space: normal; }
.table thead small { display: block; }
.table th:first-child button { padding-left: 0; }
.table tbody tr:hover > * { background: var(--rail); }
.scripted .table thead button { cursor: pointer; }
.scripted .table thead button:hover { background: var(--rail); }
.scripted [aria-sort=ascending] button, .scripted [aria-sort=descending] button { color: var(--bar); }
.scripted .table thead button::before { content: "\25B2"; display: block; font-size: 9px; line-height: 1;
  visibility: hidden; }
.scripted [aria-sort=ascending] button::before, .scripted [aria-sort=descending] button::before {
  visibility: visible !important; }
.scripted [aria-sort=descending] button::before { content: "\25BC" !important; }
:focus-visible { outline: 2px solid var(--bar); outline-offset: -2px; }

.chart h3 { font: 600 14px/1.4 inherit; font-family: inherit; }
#groups .chart { max-width: 680px; }
.quality { display: block; width: 100%; height: auto; margin-top: 10px; font-size: 10px; }
.quality .clip { fill: var(--quiet); fill-opacity: .45; }
.quality .clip:hover { fill-opacity: 1; }
.mean { stroke: var(--card); }
.curve { fill: none; stroke-width: 2; }
.curve.v0 { stroke-width: 3; }
.v0 { stroke: var(--v0); } .v1 { stroke: var(--v1); } .v2 { stroke: var(--v2); } .v3 { stroke: var(--v3); }
.v4 { stroke: var(--v4); } .v5 { stroke: var(--v5); } .v6 { stroke: var(--v6); } .v7 { stroke: var(--v7); }
.mean.v0 { fill: var(--v0); } .mean.v1 { fill: var(--v1); } .mean.v2 { fill: var(--v2); }
.mean.v3 { fill: var(--v3); } .mean.v4 { fill: var(--v4); } .mean.v5 { fill: var(--v5); }
.mean.v6 { fill: var(--v6); } .mean.v7 { fill: var(--v7); }
.v4, .v5, .v6, .v7 { stroke-dasharray: 6 3; }
.mean { stroke-dasharray: none; }
.legend { display: flex; flex-wrap: wrap; gap: 4px 18px; margin: 10px 0 0; padding: 0; list-style: none;
  font-size: 13px; }
.legend li { display: flex; align-items: center; gap: 7px; min-width: 0; overflow-wrap: anywhere; }
.legend svg { flex: none; }

.clip { margin: 0 0 36px; break-inside: avoid; }
.clip h3 { overflow-wrap: anywhere; }
.clip:target h3 { color: var(--bar); }
.seen { display: grid; grid-template-columns: minmax(0, 720px) minmax(0, 1fr); gap: 16px 28px; align-items: start; }
.seen .summary { grid-template-columns: repeat(auto-fill, minmax(min(100%, 170px), 1fr)); }
.summary dd { font-variant-numeric: tabular-nums; }
.views { display: none; gap: 6px; margin-bottom: 8px; }
.scripted .views { display: flex; }
.views button { padding: 4px 12px; border: 1px solid var(--line); border-radius: 6px; background: var(--card);
  color: inherit; font: inherit; font-size: 13px; cursor: pointer; }
.views button[aria-pressed=true] { border-color: var(--bar); background: var(--bar); color: var(--card); }
.views button:focus-visible { outline-offset: 2px; }
.slider { position: relative; overflow: hidden; border-radius: 6px; touch-action: pan-y; user-select: none; }
.slider img { display: block; width: 100%; height: auto; }
.slider .after { position: absolute; inset: 0; height: 100%; }
.slider .after[hidden] { display: none; }
.slider .divider, .slider input { display: none; }
.scripted .slider { cursor: ew-resize; }
.scripted .slider .divider { display: block; position: absolute; top: 0; bottom: 0; width: 2px; margin-left: -1px;
  background: #fff; box-shadow: 0 0 0 1px #0008; }
.scripted .slider .divider::after { content: ""; position: absolute; top: 50%; left: 50%; width: 26px; height: 26px;
  margin: -13px; border: 2px solid #fff; border-radius: 50%; background: #0007; box-shadow: 0 0 0 1px #0008; }
.scripted .slider input { display: block; position: absolute; inset: 0; width: 100%; height: 100%; margin: 0;
  opacity: 0; pointer-events: none; }
.slider:has(input:focus-visible) { outline: 3px solid var(--bar); outline-offset: 2px; }
.sides { display: flex; justify-content: space-between; margin-top: 4px; color: var(--quiet);
  font-size: 13px; }
html:not(.scripted) .sides span:first-child { display: none; }
.rows { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 250px), 1fr)); gap: 8px 16px;
  margin-top: 6px; }
.rows figure { margin: 0; }
.rows figcaption { color: var(--quiet); font-size: 13px; }
.clip > .figures { margin-top: 14px; }
.over-time { display: block; width: 100%; height: 150px; border-radius: 4px; image-rendering: pixelated; }
footer { margin-top: 48px; border-top: 1px solid var(--line); padding-top: 12px; color: var(--quiet); font-size: 13px; }
footer p { max-width: 100ch; margin-bottom: 6px; }
@media (max-width: 900px) { .seen { grid-template-columns: minmax(0, 1fr); } }
@media (max-width: 640px) {
  .quality { font-size: 13px; }
  .table th[scope=row] { max-width: 38vw; }
  .error { min-width: 0; }
  .over-time { height: 110px; } }
@media print { .table { overflow: visible; } .table table { font-size: 8pt; } }
)css";

}  // namespace shimmer::restore::app
