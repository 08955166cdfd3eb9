// Cubic B-splines over a grid of points, row by row: their coefficients from values, the same spline on a
// grid twice as fine, and its values there. Everything is local and every element is computed on its own, so
// that the same bits come out on every SIMD target and wherever a row begins.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace shimmer::noise {

template <size_t n>
using Rows = std::array<const float*, n>;

// Coefficients from values, along x (rows: one row shifted by -3 .. 3) or along y (rows -3 .. 3):
//   1 - d/6 + d^2/36 - d^3/216,  d the second difference: the inverse of 1 + d/6 = (1 4 1)/6 but for
//   d^4/1296.
inline constexpr int kSplineFilterReach = 3;
void FilterSplineRow(const Rows<2 * kSplineFilterReach + 1>& rows, std::span<float> out);

// out += coefficients of the same spline on a grid twice as fine, from an even point 2 j on: (a + 6 b + c)/8
// there, (b + c)/2 between. rows begin at coefficient j - 1; of an even fine row 2 i they are i - 1, i, i +
// 1, of an odd one i, i + 1 as well. Reads out.size() / 2 + 2 coefficients; out.size() is even.
void AddRefinedSplineRow(const Rows<3>& rows, bool odd_row, std::span<float> out);

// out = values of the spline at points of a grid twice as fine, from point 2 j + skip on, skip 0 or 1:
// (a + 4 b + c)/6 at even points, (a + 23 b + 23 c + e)/48 at odd ones. rows begin at coefficient j - 1; of
// row 2 i or 2 i + 1 they are i - 1 .. i + 2. Reads (skip + out.size() + 1) / 2 + 3 coefficients.
void EvaluateSplineRow(const Rows<4>& rows, bool odd_row, size_t skip, std::span<float> out);

void MixRows(const std::array<float, 4>& weights, const Rows<4>& rows, std::span<float> out);
void AddRow(const float* row, std::span<float> out);  // out += row

}  // namespace shimmer::noise
