// What the fast blur does to rows of floats. Each element on its own, so that the same bits come out on every
// SIMD target and wherever a row begins. No alignment is asked for, and nothing beyond the stated elements is
// read or written.
#pragma once

#include <cstddef>
#include <span>

namespace shimmer::sim {

// A symmetric kernel: out[i] = w[0] centre[i] + sum_k w[k] (before[k][i] + after[k][i]), k = 1 ..
// weights.size() - 1, i < out.size(). before and after are the rows k above and below, or the row itself
// shifted by k.
void ConvolveRow(std::span<const float> weights, const float* centre, const float* const* before,
                 const float* const* after, std::span<float> out);

// out[i] = sum_k w[k] rows[k][i], of four rows.
void MixFourRows(std::span<const float, 4> weights, const float* const* rows, std::span<float> out);

// Cubic B-splines on a grid twice as fine: in[0] is the coefficient at grid point -1, and n = out.size() / 2.
// Reads in[0 .. n + 2]; out.size() is even.
void RefineSpline(const float* in, std::span<float> out);  // coefficients of the fine grid, from point 0 on
void EvaluateSpline(const float* in,
                    std::span<float> out);  // values at the fine grid's points, from point 0 on

}  // namespace shimmer::sim
