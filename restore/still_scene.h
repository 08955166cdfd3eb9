// The scene without what moves in it, and by how much a frame lies outside of it.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "restore/local_interval.h"
#include "restore/scene_sample.h"

namespace shimmer::restore {

struct StillScene {
  LocalInterval interval;  // within a px
  LocalInterval wide;      // within three times tilt_px: turbulence alone hardly ever leaves it
  double tilt_px = 0;      // how far turbulence moves the scene along its gradients, RMS
  cv::Mat picture;         // CV_32FC1 or 3, in levels
  // Of DistanceTo(interval): what is beyond it is no part of the scene. CV_32FC1, in levels: higher where
  // turbulence takes frames further out of the interval, and where the picture is but continued from around.
  cv::Mat threshold;
};

// First the median of each pixel's calmest samples, the movers left out; where no sample is left, or where
// fewer than a third of them look like it, the picture grows over what looks alike (scene_growth.h), and the
// rest of it is continued from around. Then the median of all samples that lie inside of its interval. Throws
// std::invalid_argument for no samples. The same on any number of threads. passing: CV_8UC1, not 0 where what
// moves only passes: the samples are used there even if all show something that moves. Empty: nowhere.
StillScene FindStillScene(const std::vector<SceneSample>& samples, const cv::Mat& passing = {});

}  // namespace shimmer::restore
