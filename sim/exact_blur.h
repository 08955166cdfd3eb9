// The exact spatially varying Gaussian: each output pixel gathers with its own kernel, in double. The truth
// that faster blurs are measured against.
#pragma once

#include <opencv2/core.hpp>
#include <span>

namespace shimmer::sim {

// out pixel i = sum_k G(k; sigma[i]) frame(first + (i, 0) + k), G normalised to 1 on the pixel grid, out to
// GaussianRadius(sigma[i]) in x and y. sigma 0: the pixel itself, exactly.
// frame: CV_32FC1 or CV_32FC3, with that radius around every pixel read. Same bits on every SIMD target.
void ExactBlurRow(const cv::Mat& frame, cv::Point first, std::span<const float> sigma_px, float* out);

}  // namespace shimmer::sim
