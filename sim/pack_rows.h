// A row of a picture between interleaved samples, as files and cv::Mat hold them, and planes of floats, as
// kernels take them. The same bits on every SIMD target.
#pragma once

#include <opencv2/core.hpp>
#include <span>

namespace shimmer::sim {

// planes[c][i] = channel c of pixel (first.x + i, first.y), i < width. frame: CV_8UC1, CV_8UC3 (meaning
// v / 255), CV_16UC1, CV_16UC3 (v / 65535), CV_32FC1 or CV_32FC3; the float nearest to the quotient. Throws
// std::invalid_argument on any other type.
void UnpackRow(const cv::Mat& frame, cv::Point first, size_t width, float* const* planes);

// Pixel i of to = (planes[0][i], planes[1][i], ...), i < width, channels 1 or 3; one plane for three channels
// makes them equal. In whole numbers, below 0 and NaN are 0, above 1 is 1, and 1 is 255 or 65535: the exact
// product, rounded to nearest, ties to even. Floats are copied. Throws std::invalid_argument on other counts.
void PackRow(std::span<const float* const> planes, int channels, size_t width, uint8_t* to);
void PackRow(std::span<const float* const> planes, int channels, size_t width, uint16_t* to);
void PackRow(std::span<const float* const> planes, int channels, size_t width, float* to);

// The same to pixels first.x .. of row first.y of a frame of UnpackRow's types.
void PackRow(std::span<const float* const> planes, size_t width, cv::Point first, cv::Mat& frame);

}  // namespace shimmer::sim
