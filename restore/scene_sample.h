// A frame of a video, of which with others its still scene is found.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::restore {

// All of one size.
struct SceneSample {
  cv::Mat frame;   // CV_32FC1 or 3, in levels
  cv::Mat own;     // CV_8UC1, 0: filled, not to be used
  cv::Mat movers;  // CV_8UC1, not 0: seen to move, not to be used
  cv::Mat unrest;  // CV_32FC1: how much it differs from neighbouring frames; the calmest samples are used
};

}  // namespace shimmer::restore
