// 3-D Perlin noise (Perlin 2002, in the form of pnoise3 of the noise library that the paper names): gradients
// by hash & 15, fade 6 t^5 - 15 t^4 + 10 t^3. Values in [-1, 1].
#pragma once

#include <span>

#include "noise/fixed.h"
#include "noise/lattice.h"

namespace shimmer::noise {

// out[i] += amplitude * n(x + (x0 + i) step, y, z), i < out.size(): pixels x0 .. of a row. Coordinates in
// cells, any size. Error against PerlinDouble below 5e-6 amplitude. The same bits on every SIMD target, and
// wherever a row begins.
void AddPerlinRow(const Permutation& permutation, Fixed x, Fixed step, Fixed y, Fixed z, float amplitude,
                  int64_t x0, std::span<float> out);

}  // namespace shimmer::noise
