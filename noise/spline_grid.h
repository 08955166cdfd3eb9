// Grids of points over an area of pixels, and cubic B-splines on them. A grid's points lie at absolute
// multiples of its spacing, and every coefficient depends on values near it alone, so that neither depends on
// the area.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace shimmer::noise {

struct PixelArea {  // or an area of grid points
  int64_t x0 = 0, y0 = 0;
  int width = 0, height = 0;

  size_t Points() const { return static_cast<size_t>(width) * height; }
  friend bool operator==(const PixelArea&, const PixelArea&) = default;
};

struct Grid {
  PixelArea area;
  std::vector<float> values;  // [y][x]

  float* At(int64_t y, int64_t x) { return values.data() + (y - area.y0) * area.width + (x - area.x0); }
  const float* At(int64_t y, int64_t x) const {
    return values.data() + (y - area.y0) * area.width + (x - area.x0);
  }
  std::span<float> Row(int64_t y) { return {At(y, area.x0), static_cast<size_t>(area.width)}; }
};

// The coefficients of spacing 2 px that pixels need, and those that a grid needs of one twice as coarse.
PixelArea SplineAreaOf(const PixelArea& pixels);
PixelArea CoarserAreaOf(const PixelArea& fine);

// Writes the coefficients of the spline whose values add(y, x0, row) adds, at points x0 .. of row y.
using AddValues = std::function<void(int64_t y, int64_t x0, std::span<float> row)>;
void FilterSpline(const AddValues& add, Grid& spline);

// fine += coarse, whose spacing is twice as wide and whose area holds CoarserAreaOf(fine.area): exactly the
// same spline.
void AddRefined(const Grid& coarse, Grid& fine);

// Values of a spline of spacing 2 px at pixels x0 .. of row y.
void EvaluateSpline(const Grid& spline, int64_t y, int64_t x0, std::span<float> out);

}  // namespace shimmer::noise
