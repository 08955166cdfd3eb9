#include "noise/spline_grid.h"

#include <algorithm>

#include "noise/spline_rows.h"

namespace shimmer::noise {
namespace {

constexpr int kReach = kSplineFilterReach, kTaps = 2 * kReach + 1;

struct Range {
  int64_t first;
  int count;
};

// Points first .. last, and one more where that makes the range begin and end between pairs.
Range InPairs(int64_t first, int64_t last) {
  first &= ~int64_t{1}, last |= 1;
  return {first, static_cast<int>(last - first + 1)};
}

PixelArea AreaOf(Range x, Range y) { return {x.first, y.first, x.count, y.count}; }

}  // namespace

PixelArea SplineAreaOf(const PixelArea& pixels) {  // i - 1 .. i + 2 around each pixel 2 i or 2 i + 1
  const auto along = [](int64_t first, int count) {
    return InPairs((first >> 1) - 1, ((first + count - 1) >> 1) + 2);
  };
  return AreaOf(along(pixels.x0, pixels.width), along(pixels.y0, pixels.height));
}

PixelArea CoarserAreaOf(const PixelArea& fine) {  // i - 1 .. i + 1 around each pair 2 i, 2 i + 1
  const auto along = [](int64_t first, int count) {
    return InPairs((first >> 1) - 1, ((first + count - 1) >> 1) + 1);
  };
  return AreaOf(along(fine.x0, fine.width), along(fine.y0, fine.height));
}

void FilterSpline(const AddValues& add, Grid& spline) {
  const PixelArea& area = spline.area;
  std::vector<float> values(area.width + 2 * kReach);
  std::vector<float> last(static_cast<size_t>(area.width) *
                          kTaps);  // rows filtered along x; row y is the y mod kTaps-th
  const auto last_row = [&](int64_t y) { return last.data() + (y - area.y0 + kReach) % kTaps * area.width; };
  for (int64_t y = area.y0 - kReach; y < area.y0 + area.height + kReach; ++y) {
    std::ranges::fill(values, 0.0f);
    add(y, area.x0 - kReach, values);
    Rows<kTaps> shifted, rows;
    for (int k = 0; k < kTaps; ++k) shifted[k] = values.data() + k;
    FilterSplineRow(shifted, {last_row(y), static_cast<size_t>(area.width)});
    const int64_t centre = y - kReach;
    if (centre < area.y0) continue;
    for (int k = 0; k < kTaps; ++k) rows[k] = last_row(centre + k - kReach);
    FilterSplineRow(rows, spline.Row(centre));
  }
}

void AddRefined(const Grid& coarse, Grid& fine) {
  const int64_t x = (fine.area.x0 >> 1) - 1;
  for (int64_t y = fine.area.y0; y < fine.area.y0 + fine.area.height; ++y) {
    const int64_t i = y >> 1;
    AddRefinedSplineRow({coarse.At(i - 1, x), coarse.At(i, x), coarse.At(i + 1, x)}, y & 1, fine.Row(y));
  }
}

void EvaluateSpline(const Grid& spline, int64_t y, int64_t x0, std::span<float> out) {
  const int64_t i = y >> 1, x = (x0 >> 1) - 1;
  EvaluateSplineRow({spline.At(i - 1, x), spline.At(i, x), spline.At(i + 1, x), spline.At(i + 2, x)}, y & 1,
                    x0 & 1, out);
}

}  // namespace shimmer::noise
