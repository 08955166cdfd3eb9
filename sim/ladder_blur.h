// The fast spatially varying Gaussian: a few blurred copies (sim/level_ladder.h), mixed for each pixel's own
// sigma. Against exact_blur.h on photographs: RMS below 0.1/255 at every sigma
// (tests/sim/ladder_blur_test.cpp).
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "sim/level_ladder.h"
#include "sim/level_pyramid.h"
#include "sim/mixture_weights.h"

namespace shimmer::sim {

class LadderBlur {
 public:
  // frame: CV_32FC1 or CV_32FC3, with ladder.margin_px() px around what will be read. ladder must outlive
  // this.
  LadderBlur(const cv::Mat& frame, const LevelLadder& ladder);

  // out pixel i = frame, blurred by sigma[i], at first + (i, 0); first counted from the frame's corner,
  // border included. Levels that no sigma of a stretch of the row asks for are not computed. Any order, any
  // thread: the same bits.
  void Row(cv::Point first, std::span<const float> sigma_px, float* out) const;

 private:
  const LevelLadder& ladder_;
  MixtureTables tables_;
  std::vector<std::vector<float>> fine_weights_;  // [level]
  std::vector<cv::Mat> planes_;                   // [channel]
  std::vector<std::vector<CoarsePlane>> coarse_;  // [channel][level]
};

}  // namespace shimmer::sim
