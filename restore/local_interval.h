// The values that a still scene takes around each pixel, and how far a frame lies outside of them.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::restore {

// In each pixel the range that the scene takes within a px or two around it: turbulence moves a pixel by
// less, so that edges stay inside of it.
struct LocalInterval {
  cv::Mat low, high;  // CV_32FC1 or 3, in levels
};
LocalInterval IntervalOf(const cv::Mat& scene, int radius_px);

// How far each pixel lies outside, in the channel in which that is most, smoothed (sigma 1.5 px: turbulence
// and noise are finer than what moves). CV_32FC1 in levels, 0 or more.
cv::Mat DistanceTo(const LocalInterval& interval, const cv::Mat& frame);

// By how much more the scene changes within the wide interval than within the narrow one: how far turbulence
// can take a frame out of the narrow one. CV_32FC1 in levels, smoothed alike.
cv::Mat ExcessOf(const LocalInterval& narrow, const LocalInterval& wide);

}  // namespace shimmer::restore
