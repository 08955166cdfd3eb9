#include "cli/report_style.h"

namespace shimmer::cli {

const char* const kReportStyle = R"css(
:root { color-scheme: light dark;
  --page: #fbfbf9; --card: #fff; --text: #1d2327; --quiet: #5a646b; --line: #d9dcda; --grid: #e8eae8;
  --bar: #3d74b8; --rail: #eceeed; --hit: #3d74b818; --median: #b4451f; --bad: #a52a1a; --bad-page: #fdf0ed; }
@media (prefers-color-scheme: dark) { :root {
  --page: #15181a; --card: #1d2124; --text: #e4e7e8; --quiet: #a0a9ae; --line: #363c40; --grid: #2b3033;
  --bar: #6ea3e0; --rail: #2b3033; --hit: #6ea3e024; --median: #f0926b; --bad: #ff9d8a; --bad-page: #33201c; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1320px; padding: 28px 32px 48px; background: var(--page); color: var(--text);
  font: 15px/1.45 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "DejaVu Sans", sans-serif; }
h1 { margin: 0; font-size: 28px; line-height: 1.2; overflow-wrap: anywhere; }
h2 { margin: 40px 0 12px; font-size: 19px; }
h2 + p { margin: -6px 0 14px; }
p { margin: 0; }
a { color: inherit; }
.quiet, h2 + p { color: var(--quiet); max-width: 100ch; }
.empty { margin: 40px 0; font-size: 17px; }
.kind { color: var(--quiet); letter-spacing: .02em; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 150px), 1fr)); gap: 12px;
  margin: 20px 0 12px; }
.tile, .chart { background: var(--card); border: 1px solid var(--line); border-radius: 8px; }
.tile { padding: 10px 14px 12px; }
.tile b { display: block; font-size: 25px; font-weight: 600; line-height: 1.25; }
.tile.bad { border-color: var(--bad); background: var(--bad-page); }
.tile.bad b { color: var(--bad); }
.tile span { color: var(--quiet); font-size: 13px; }
table { border-collapse: collapse; width: 100%; }
th, td { padding: 5px 16px 5px 0; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
th { font-weight: 600; }
.summary { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 150px), 1fr)); gap: 10px 20px; margin: 0; }
.summary dt { color: var(--quiet); font-size: 13px; }
.summary dd { margin: 0; }
.summary dd, .failures td { overflow-wrap: anywhere; unicode-bidi: isolate; }
.failures .count { text-align: right; white-space: nowrap; overflow-wrap: normal; }
.failures td { font-variant-numeric: tabular-nums; }
.sheet { overflow-x: auto; }
.sheet img { display: block; width: 100%; min-width: min(100%, 680px); height: auto; max-width: 1134px;
  border: 1px solid var(--line); border-radius: 8px; }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 350px), 1fr)); gap: 16px; }
.chart { margin: 0; padding: 14px 16px; min-width: 0; break-inside: avoid; }
.chart h3 { margin: 0 0 2px; font: 600 14px/1.4 ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace;
  overflow-wrap: anywhere; }
.chart figcaption p, .figures, .none { color: var(--quiet); font-size: 13px; }
#sources .bars { columns: 2 400px; column-gap: 32px; }
.histogram { display: block; width: 100%; height: auto; margin: 10px 0 4px; font-size: 11px; }
svg text { fill: var(--quiet); font-variant-numeric: tabular-nums; }
svg .median { fill: var(--median); }
svg line.median { stroke: var(--median); stroke-width: 1.5; }
svg .behind { stroke: var(--card); stroke-width: 3; }
svg .grid { stroke: var(--grid); }
svg .axis { stroke: var(--quiet); }
svg .bar { fill: var(--bar); }
svg .rail { fill: var(--rail); }
svg .hit { fill: transparent; }
.bin:hover .hit { fill: var(--hit); }
.bars { list-style: none; margin: 12px 0 4px; padding: 0; }
.bars li { display: grid; break-inside: avoid; grid-template-columns: 1fr auto; column-gap: 12px; margin-bottom: 7px; font-size: 13px; }
.bars .value { overflow-wrap: anywhere; unicode-bidi: isolate; }
.bars .count { font-variant-numeric: tabular-nums; white-space: nowrap; text-align: right; }
.bars small { display: inline-block; min-width: 4.2em; color: var(--quiet); font-size: 12px; }
.bars .row { grid-column: 1 / -1; margin-top: 2px; }
details { margin-top: 36px; }
summary { cursor: pointer; font-size: 19px; font-weight: 600; }
pre { overflow-x: auto; padding: 14px 16px; background: var(--card); border: 1px solid var(--line); border-radius: 8px;
  font: 13px/1.45 ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace; }
@media (max-width: 640px) {
  body { padding: 18px 16px 32px; }
  .sheet img { min-width: 680px; }
  .tiles, .summary { grid-template-columns: 1fr 1fr; } }
@media print {
  :root { --page: #fff; --card: #fff; --text: #000; --quiet: #444; --line: #bbb; --grid: #ddd; --bar: #3d74b8;
    --rail: #eee; --median: #b4451f; --bad: #a52a1a; --bad-page: #fff; }
  body { max-width: none; padding: 0; font-size: 11pt; }
  .sheet { overflow: visible; }
  .sheet img { min-width: 0; max-width: 100%; }
  .charts { grid-template-columns: 1fr 1fr; }
  h2 { break-after: avoid; }
  tr { break-inside: avoid; }
  pre { white-space: pre-wrap; overflow-wrap: anywhere; } }
)css";

}  // namespace shimmer::cli
