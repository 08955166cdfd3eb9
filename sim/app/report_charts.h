// Charts of a report, as HTML with inline SVG. What a reader of the page may want as numbers stands in data-
// attributes: data-key of a chart; data-low, data-high and data-count of a histogram's bins, data-value and
// data-count of bars.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/app/bins.h"

namespace shimmer::app {

struct ChartTexts {
  std::string key;                 // "tilt.strength_px"
  std::string unit;                // "px"; empty: none
  std::vector<std::string> notes;  // lines below the title; empty ones are left out
};

// values: of clips; finite, ascending. None: the chart says so.
std::string HistogramHtml(const ChartTexts& texts, std::span<const double> values, cli::AxisKind kind);

struct BarRow {
  std::string value;
  int64_t count;  // of clips
};

// The first kMostBars rows, and how many more there are.
std::string BarsHtml(const ChartTexts& texts, std::span<const BarRow> rows);
inline constexpr size_t kMostBars = 20;

}  // namespace shimmer::app
