// Sums over rows of a field, for what the manifest says of a clip.
#pragma once

#include <span>

namespace shimmer::sim {

// In 16 partial sums, whatever the vector's length: the same bits on every SIMD target. Relative error below
// 1e-5 for rows of up to 2^15.
double SumOfRow(std::span<const float> row);
double SumOfSquares(std::span<const float> row);

}  // namespace shimmer::sim
