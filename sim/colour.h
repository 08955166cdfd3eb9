// The sRGB transfer (IEC 61966-2-1), for simulating in linear light.
#pragma once

#include <opencv2/core.hpp>
#include <span>

namespace shimmer::sim {

// A row of samples in place. Error below 1e-6, relative to values above 1. Below 0 both are linear, as near
// 0; above 1 they go on. Samples are finite. The same bits on every SIMD target.
void DecodeSrgbRow(std::span<float> samples);  // stored value -> linear light
void EncodeSrgbRow(
    std::span<float> samples);  // linear light -> stored value; negative light (a bicubic's undershoot) is 0

// Of every sample of a float image.
cv::Mat DecodeSrgb(const cv::Mat& stored);
cv::Mat EncodeSrgb(const cv::Mat& linear);

}  // namespace shimmer::sim
