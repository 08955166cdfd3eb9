// A frame as planes.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::sim {

// A frame's channels, one CV_32FC1 each, all of one size: 1 (grey) or 3.
using Planes = std::vector<cv::Mat>;

}  // namespace shimmer::sim
