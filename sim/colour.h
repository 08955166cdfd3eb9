// The sRGB transfer (IEC 61966-2-1), for simulating in linear light.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::sim {

// Of every sample of a float image, error below 1e-6. Below 0 both are linear, as near 0; above 1 they go on.
cv::Mat DecodeSrgb(const cv::Mat& stored);  // stored value -> linear light
cv::Mat EncodeSrgb(
    const cv::Mat& linear);  // linear light -> stored value; negative light (a bicubic's undershoot) is 0

}  // namespace shimmer::sim
