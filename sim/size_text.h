// A size as people write it.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace shimmer::sim {

// "320x240"
inline std::string SizeText(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace shimmer::sim
