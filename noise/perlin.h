// 3-D Perlin noise (Perlin 2002, in the form of pnoise3 of the noise library that the paper names): gradients
// by hash & 15, fade 6 t^5 - 15 t^4 + 10 t^3. Values in [-1, 1].
#pragma once

#include <span>

#include "noise/fixed.h"
#include "noise/lattice.h"
#include "noise/row_blocks.h"

namespace shimmer::noise {

// A step of a row's pixels along x: one serves many rows.
struct PerlinStep {
  PerlinStep(Fixed step_px) : x(step_px) {}  // cells
  RowStep x;
};

// out[i] += amplitude * n(x + (x0 + i) step, y, z), i < out.size(): pixels x0 .. of a row. Coordinates in
// cells, any size. Error against PerlinDouble below 5e-6 amplitude. The same bits on every SIMD target, and
// wherever a row begins.
void AddPerlinRow(const Permutation& permutation, Fixed x, const PerlinStep& step, Fixed y, Fixed z,
                  float amplitude, int64_t x0, std::span<float> out);

}  // namespace shimmer::noise
