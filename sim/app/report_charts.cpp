#include "sim/app/report_charts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "cli/html.h"
#include "cli/number_text.h"
#include "cli/page.h"
#include "cli/svg.h"

namespace shimmer::app {
namespace {

using cli::AxisKind;
using cli::EscapeHtml;
using cli::Line;
using cli::Px;
using cli::Rect;
using cli::Text;
using cli::Ticks;

// px of the histogram's own coordinates; the page shows it at about this size.
constexpr double kWidth = 360, kHeight = 200, kLeft = 54, kRight = 12, kTop = 24, kBottom = 42;
constexpr double kBase = kHeight - kBottom, kWidestBar = 36;

std::string WithUnit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

double MedianOf(std::span<const double> sorted) {
  const size_t n = sorted.size();
  return (sorted[(n - 1) / 2] + sorted[n / 2]) / 2;
}

// Where numbers and counts lie in the drawing.
class Plane {
 public:
  Plane(double low, double high, bool logarithmic, double most)
      : low_(low), high_(high), logarithmic_(logarithmic), most_(most) {}

  double X(double value) const {
    const double part =
        logarithmic_ ? std::log(value / low_) / std::log(high_ / low_) : (value - low_) / (high_ - low_);
    return kLeft + (kWidth - kLeft - kRight) * part;
  }
  bool logarithmic() const { return logarithmic_; }
  double Y(double count) const { return kBase - (kBase - kTop) * count / most_; }

 private:
  double low_, high_;
  bool logarithmic_;
  double most_;
};

std::string BinSvg(const Bin& bin, const Plane& plane, const std::string& unit) {
  const double left = plane.X(bin.low), right = plane.X(bin.high), top = plane.Y(double(bin.count));
  const double width = std::min(right - left - 1, kWidestBar), height = kBase - top;
  char numbers[120];
  std::snprintf(numbers, sizeof numbers, "data-low=\"%.9g\" data-high=\"%.9g\" data-count=\"%lld\"", bin.low,
                bin.high, static_cast<long long>(bin.count));
  return "<g class=\"bin\" " + std::string(numbers) + "><title>" +
         EscapeHtml(WithUnit(bin.text, unit) + ": " + cli::Counted(bin.count, "clip")) + "</title>" +
         Rect("hit", left, kTop, right - left, kBase - kTop) +  // to point at, however low the bar
         Rect("bar", (left + right - width) / 2, top, width, height) + "</g>\n";
}

// Short enough for the axis: "100,000", "2.5M".
std::string CountText(double count) {
  return count < 1e6 ? cli::Grouped(static_cast<int64_t>(count)) : cli::ShortText(count / 1e6) + "M";
}

std::string AxesSvg(const ChartTexts& texts, std::span<const double> ticks, double tick_step, double most,
                    const Plane& plane) {
  std::string svg;
  for (const double count : Ticks(0, most, 5, AxisKind::kWhole)) {
    if (count > 0) svg += Line(kLeft, plane.Y(count), kWidth - kRight, plane.Y(count), "grid");
    svg += Text(kLeft - 6, plane.Y(count) + 4, "end", CountText(count));
  }
  svg += Line(kLeft, kBase, kWidth - kRight, kBase, "axis");
  for (const double tick : ticks) {
    svg += Line(plane.X(tick), kBase, plane.X(tick), kBase + 4, "axis");
    svg += Text(plane.X(tick), kBase + 17, "middle",
                tick_step > 0 ? cli::RoundedText(tick, tick_step) : cli::ShortText(tick));
  }
  std::string name = texts.unit.empty() ? texts.key.substr(texts.key.rfind('.') + 1) : texts.unit;
  if (plane.logarithmic()) name += ", log scale";
  svg += Text((kLeft + kWidth - kRight) / 2, kHeight - 6, "middle", name);
  return svg + Text(kLeft - 6, kTop - 10, "end", "clips") + "\n";
}

std::string MedianSvg(double median, const Plane& plane) {
  const double x = plane.X(median);
  const bool at_right = x > kWidth * 0.6;
  return Line(x, kTop - 6, x, kBase, "behind") + Line(x, kTop - 6, x, kBase, "median") +
         Text(x + (at_right ? -5 : 5), kTop - 10, at_right ? "end" : "start",
              "median " + cli::ShortText(median), "median") +
         "\n";
}

}  // namespace

std::string HistogramHtml(const ChartTexts& texts, std::span<const double> values, AxisKind kind) {
  if (values.empty()) return cli::Chart(texts.key, texts.notes, "<p class=\"none\">No clip has it.</p>\n");
  // A ratio of less than two is as good as linear, and has rounder bins.
  const double ratio = values.front() > 0 ? values.back() / values.front() : 0;
  if (kind == AxisKind::kLogarithmic && (ratio < 2 || std::isinf(ratio))) kind = AxisKind::kLinear;
  const std::vector<Bin> bins = PutIntoBins(values, kind);
  const double low = bins.front().low, high = bins.back().high, median = MedianOf(values);
  const double most = double(std::ranges::max(bins, {}, &Bin::count).count);
  const Plane plane(low, high, kind == AxisKind::kLogarithmic, most);
  const std::vector<double> ticks =
      bins.size() == 1 ? std::vector<double>{median} : Ticks(low, high, 6, kind);
  const bool even = kind != AxisKind::kLogarithmic && ticks.size() > 1;

  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  const std::string figures = "min " + cli::ShortText(values.front()) + ", median " + cli::ShortText(median) +
                              ", mean " + cli::ShortText(sum / double(values.size())) + ", max " +
                              WithUnit(cli::ShortText(values.back()), texts.unit);
  std::string svg =
      "<svg class=\"histogram\" viewBox=\"0 0 " + Px(kWidth) + " " + Px(kHeight) +
      "\" role=\"img\" aria-label=\"" +
      EscapeHtml(texts.key + " of " + cli::Counted(std::ssize(values), "clip") + ": " + figures) + "\">\n" +
      AxesSvg(texts, ticks, even ? ticks[1] - ticks[0] : 0, most, plane);
  for (const Bin& bin : bins) svg += BinSvg(bin, plane, texts.unit);
  return cli::Chart(
      texts.key, texts.notes,
      svg + MedianSvg(median, plane) + "</svg>\n<p class=\"figures\">" + EscapeHtml(figures) + "</p>\n");
}

std::string BarsHtml(const ChartTexts& texts, std::span<const BarRow> rows) {
  int64_t all = 0, most = 1, shown = 0;
  for (const BarRow& row : rows) all += row.count, most = std::max(most, row.count);
  if (all == 0) return cli::Chart(texts.key, texts.notes, "<p class=\"none\">No clip has it.</p>\n");
  std::string html = "<ol class=\"bars\">\n";
  for (const BarRow& row : rows.first(std::min(rows.size(), kMostBars))) {
    const double share = 100 * double(row.count) / double(all);
    shown += row.count;
    const std::string data =
        "data-value=\"" + EscapeHtml(row.value) + "\" data-count=\"" + std::to_string(row.count) + "\"";
    html += cli::Bar({row.value, cli::Grouped(row.count), Px(share) + " %",
                      row.value + ": " + cli::Counted(row.count, "clip")},
                     data, 100 * double(row.count) / double(most));
  }
  html += "</ol>\n";
  if (rows.size() > kMostBars)
    html += "<p class=\"figures\">and " + cli::Grouped(std::ssize(rows) - int64_t{kMostBars}) + " more, of " +
            cli::Counted(all - shown, "clip") + "</p>\n";
  return cli::Chart(texts.key, texts.notes, html);
}

}  // namespace shimmer::app
