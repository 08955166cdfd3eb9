// The default interpolation of sim/warp.h, in vectors.
#pragma once

#include <opencv2/core.hpp>
#include <span>

namespace shimmer::sim {

// WarpRow for Interpolation::kBicubic. The same bits on every SIMD target.
void BicubicRow(const cv::Mat& frame, cv::Point first, std::span<const float> dx, std::span<const float> dy,
                float* out);

}  // namespace shimmer::sim
