// 3-D simplex noise (Perlin 2001, in the form of snoise3 of the noise library that the paper names): skew
// 1/3, unskew 1/6, n = scale * sum over four corners of max(0, r^2 - |p|^2)^4 (gradient . p). Values in (-1,
// 1) for the classic kernel.
#pragma once

#include <span>

#include "noise/fixed.h"
#include "noise/lattice.h"
#include "noise/row_blocks.h"

namespace shimmer::noise {

// r^2 = 0.6 is snoise3's: variance 0.181, |n| < 1, and jumps of up to 0.0064 where neighbouring simplices
// meet. r^2 = 0.5 is continuous; its scale gives it the same RMS.
struct SimplexKernel {
  double radius2;
  double scale;
  double bound;  // on |n|, over every place and every choice of gradients (tests/noise/statistics_test.cpp)
};
inline constexpr SimplexKernel kSimplexKernel06{0.6, 32, 0.979};
inline constexpr SimplexKernel kSimplexKernel05{0.5, 83.3, 1.084};

// What the row kernel looks up.
struct SimplexTable {
  explicit SimplexTable(const Permutation& permutation);
  alignas(64) Permutation hash;
  alignas(64) Permutation gradient;  // of each hash: an index into kGradients, hash mod 12
};

// A step of a row's pixels along x, in skewed coordinates: one serves many rows.
struct SimplexStep {
  SimplexStep(Fixed step_px);  // cells
  RowStep u, v;                // w advances as v does
  int64_t rest;                // what the thirds leave of the step, in thirds of 2^-64 cell
};

// out[i] += amplitude * n(x + (x0 + i) step, y, z), i < out.size(): pixels x0 .. of a row. Coordinates in
// cells, any size. Error against SimplexDouble below 5e-6 amplitude, but for points within 1e-6 cell of a
// simplex face, which may fall to either side. The same bits on every SIMD target, and wherever a row begins.
void AddSimplexRow(const SimplexTable& table, SimplexKernel kernel, Fixed x, const SimplexStep& step, Fixed y,
                   Fixed z, float amplitude, int64_t x0, std::span<float> out);

}  // namespace shimmer::noise
