// A clean frame as the renderer reads it: made once for a still, once a frame for a video.
#pragma once

#include <opencv2/core.hpp>

#include "sim/constant_regions.h"
#include "sim/plan.h"

namespace shimmer::sim {

// Largest magnitude of a float sample, as in files of halves: sums of such samples never overflow.
inline constexpr float kMostLight = 65504.f;

struct CleanFrame {
  // samples: CV_8U (v / 255), CV_16U (v / 65535) or CV_32F, of 1 or 3 channels. Throws std::invalid_argument
  // for other types, and where a float sample is not finite or beyond +-kMostLight.
  // origin: where its pixel (0, 0) lies in the steady frame, whose (0, 0) is the crop's first pixel.
  CleanFrame(const cv::Mat& samples, cv::Point origin, const ClipPlan& plan);

  // Its samples, which share memory with those that were given, have changed in this area. What was constant
  // there counts as varied from now on. Throws as the constructor.
  void Derive(cv::Rect area);

  cv::Point origin;
  cv::Mat samples;           // as they were given: constant regions are copied from here
  ConstantRegions constant;  // of samples
  bool
      grey;  // one plane is enough: one channel, or grey stored as RGB that neither sensor nor objects colour
  bool linear_light;
  cv::Mat light;   // one channel if grey; decoded, CV_32F, where the plan works in linear light
  cv::Mat source;  // of light, what the warp reads; empty where the plan has no tilt
};

}  // namespace shimmer::sim
