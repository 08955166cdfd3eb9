// The scene without what moves in it, and by how much a frame lies outside of it.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

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

// A frame of the video for the search of its still scene. All of one size.
struct SceneSample {
  cv::Mat frame;   // CV_32FC1 or 3, in levels
  cv::Mat own;     // CV_8UC1, 0: filled, not to be used
  cv::Mat movers;  // CV_8UC1, not 0: seen to move, not to be used
  cv::Mat unrest;  // CV_32FC1: how much it differs from neighbouring frames; the calmest samples are used
};

struct StillScene {
  LocalInterval interval;  // within a px
  LocalInterval wide;      // within three times tilt_px: turbulence alone hardly ever leaves it
  double tilt_px = 0;      // how far turbulence moves the scene along its gradients, RMS
  cv::Mat picture;         // CV_32FC1 or 3, in levels
  double threshold = 0;    // of DistanceTo: what is beyond it is no part of the scene, in levels
};

// First the median of each pixel's calmest samples, the movers left out; where no sample is left, or where
// fewer than a third of them look like it, the picture is continued from around. Then the median of all
// samples that lie inside of its interval. Throws std::invalid_argument for no samples. The same on any
// number of threads.
StillScene FindStillScene(const std::vector<SceneSample>& samples);

}  // namespace shimmer::restore
