#include "sim/app/bins.h"

#include <algorithm>
#include <cmath>

#include "cli/number_text.h"

namespace shimmer::app {
namespace {

using cli::AxisKind;
using cli::RoundUp;

constexpr int kMostBins = 30, kRatioBins = 24;

// Numbers closer than this, of their size, are one: their difference is rounding.
constexpr double kSame = 1e-9;
constexpr double kZero = 1e-100;  // as good as 0

std::vector<double> RatioEdges(double low, double high) {
  std::vector<double> edges;
  for (int i = 0; i <= kRatioBins; ++i) edges.push_back(low * std::pow(high / low, double(i) / kRatioBins));
  return edges;
}

std::vector<double> RoundEdges(double low, double high, double width) {
  // A number that is an edge but for rounding makes no bin of its own.
  const double first = std::floor(low / width + 1e-6), last = std::ceil(high / width - 1e-6);
  std::vector<double> edges;
  for (double k = first; k <= std::max(last, first + 1); ++k) edges.push_back(k * width);
  return edges;
}

// Whole numbers k, k + 1, ... k + width - 1 a bin, with edges half a number beside them.
std::vector<double> WholeEdges(double low, double high, double width) {
  std::vector<double> edges;
  for (double first = std::floor(low / width) * width; first <= high; first += width)
    edges.push_back(first - 0.5);
  edges.push_back(edges.back() + width);
  return edges;
}

double HalfWidthOfOne(double value, bool whole) {
  return whole || std::abs(value) <= kZero ? std::max(0.5, std::abs(value) / 20) : std::abs(value) / 20;
}

std::string RangeText(double low, double high, double step) {
  return cli::RoundedText(low, step) + " to " + cli::RoundedText(high, step);
}

}  // namespace

std::vector<Bin> PutIntoBins(std::span<const double> sorted, AxisKind kind) {
  const double low = sorted.front(), high = sorted.back(), size = std::max(std::abs(low), std::abs(high));
  const bool one = high - low <= std::max(kSame * size, kZero), whole = kind == AxisKind::kWhole;
  const double whole_width = one ? 1 : std::max(1.0, RoundUp((high - low + 1) / kMostBins, {1, 2, 5}));
  std::vector<double> edges;
  if (one)
    edges = {low - HalfWidthOfOne(low, whole), low + HalfWidthOfOne(low, whole)};
  else if (whole)
    edges = WholeEdges(low, high, whole_width);
  else if (kind == AxisKind::kLogarithmic)
    edges = RatioEdges(low, high);
  else
    edges = RoundEdges(low, high, RoundUp((high - low) / kMostBins, {1, 2, 2.5, 5}));

  std::vector<Bin> bins;
  for (size_t i = 0; i + 1 < edges.size(); ++i) {
    const double from = edges[i], to = edges[i + 1];
    std::string text = one ? cli::ShortText(low) : RangeText(from, to, (to - from) / 2);
    if (whole && !one)
      text = whole_width == 1 ? cli::RoundedText(from + 0.5, 1) : RangeText(from + 0.5, to - 0.5, 1);
    bins.push_back({from, to, 0, text});
  }
  for (const double value : sorted) {
    const auto above = std::upper_bound(edges.begin(), edges.end(), value) - edges.begin();
    ++bins[std::clamp<int64_t>(above - 1, 0, static_cast<int64_t>(bins.size()) - 1)].count;
  }
  return bins;
}

}  // namespace shimmer::app
