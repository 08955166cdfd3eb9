// Rows of one-channel float maps.
#pragma once

#include <opencv2/core.hpp>
#include <span>

namespace shimmer::sim {

inline std::span<float> RowOf(cv::Mat& map, int y) {
  return {map.ptr<float>(y), static_cast<size_t>(map.cols)};
}
inline std::span<const float> RowOf(const cv::Mat& map, int y) {
  return {map.ptr<float>(y), static_cast<size_t>(map.cols)};
}

}  // namespace shimmer::sim
