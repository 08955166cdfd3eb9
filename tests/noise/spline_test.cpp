// Splines on grids against their definition in double: sums of cubic B-splines.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "noise/spline_grid.h"

namespace shimmer::noise {
namespace {

// float32: six roundings of values below 8
constexpr double kRounding = 5e-6;

double BSpline(double x) {
  x = std::abs(x);
  if (x >= 2) return 0;
  return x >= 1 ? (2 - x) * (2 - x) * (2 - x) / 6 : 2.0 / 3 - x * x + x * x * x / 2;
}

double SplineAt(const Grid& coefficients, double y, double x) {
  double sum = 0;
  const auto i = static_cast<int64_t>(std::floor(x)), j = static_cast<int64_t>(std::floor(y));
  for (int64_t b = j - 1; b <= j + 2; ++b)
    for (int64_t a = i - 1; a <= i + 2; ++a) {
      const double weight = BSpline(x - static_cast<double>(a)) * BSpline(y - static_cast<double>(b));
      if (weight != 0) sum += weight * *coefficients.At(b, a);
    }
  return sum;
}

Grid EmptyGrid(const PixelArea& area) { return {area, std::vector<float>(area.Points())}; }

Grid WavyGrid(const PixelArea& area) {
  Grid grid = EmptyGrid(area);
  for (size_t i = 0; i < grid.values.size(); ++i)
    grid.values[i] = static_cast<float>(std::sin(1.7 * static_cast<double>(i * i % 1009)));
  return grid;
}

const PixelArea kAreas[] = {
    {0, 0, 1, 1}, {-3, 5, 2, 7}, {-1001, -999, 37, 3}, {1 << 20, 7, 530, 4}, {1, 1, 1031, 2}};

TEST(Spline, ValuesAreThoseOfItsDefinition) {
  for (const PixelArea& pixels : kAreas) {
    const Grid spline = WavyGrid(SplineAreaOf(pixels));
    std::vector<float> row(pixels.width);
    for (int64_t y = pixels.y0; y < pixels.y0 + pixels.height; ++y) {
      EvaluateSpline(spline, y, pixels.x0, row);
      for (int i = 0; i < pixels.width; ++i)
        ASSERT_NEAR(row[i],
                    SplineAt(spline, static_cast<double>(y) / 2, static_cast<double>(pixels.x0 + i) / 2),
                    kRounding);
    }
  }
}

TEST(Spline, ARefinedOneIsTheSame) {
  for (const PixelArea& pixels : kAreas) {
    Grid fine = EmptyGrid(SplineAreaOf(pixels));
    const Grid coarse = WavyGrid(CoarserAreaOf(fine.area));
    AddRefined(coarse, fine);
    std::vector<float> row(pixels.width);
    for (int64_t y = pixels.y0; y < pixels.y0 + pixels.height; ++y) {
      EvaluateSpline(fine, y, pixels.x0, row);
      for (int i = 0; i < pixels.width; ++i)
        ASSERT_NEAR(row[i],
                    SplineAt(coarse, static_cast<double>(y) / 4, static_cast<double>(pixels.x0 + i) / 4),
                    kRounding);
    }
  }
}

TEST(Spline, ReproducesCubics) {
  const auto cubic = [](double y, double x) {
    return 0.5 + 0.3 * x - 0.2 * y + 0.05 * x * y - 0.01 * x * x * x + 0.002 * x * x * y * y * y;
  };
  const PixelArea pixels{-7, -5, 15, 11};
  Grid spline = EmptyGrid(SplineAreaOf(pixels));
  FilterSpline(
      [&](int64_t y, int64_t x0, std::span<float> row) {
        for (size_t i = 0; i < row.size(); ++i)
          row[i] += static_cast<float>(
              cubic(static_cast<double>(y), static_cast<double>(x0) + static_cast<double>(i)));
      },
      spline);
  std::vector<float> row(pixels.width);
  for (int64_t y = pixels.y0; y < pixels.y0 + pixels.height; ++y) {
    EvaluateSpline(spline, y, pixels.x0, row);
    for (int i = 0; i < pixels.width;
         ++i)  // values up to 40 at the filter's ends: 40 float32 roundings of them
      ASSERT_NEAR(row[i], cubic(static_cast<double>(y) / 2, static_cast<double>(pixels.x0 + i) / 2), 1e-4);
  }
}

}  // namespace
}  // namespace shimmer::noise
