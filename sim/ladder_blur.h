// The fast spatially varying Gaussian: a few blurred copies (sim/level_ladder.h), mixed for each pixel's own
// sigma. What it loses against exact_blur.h is the ladder's promise (PromiseOf).
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "sim/band_levels.h"
#include "sim/level_ladder.h"
#include "sim/level_pyramid.h"
#include "sim/mixture_weights.h"
#include "sim/planes.h"

namespace shimmer::sim {

class LadderBlur {
 public:
  // frame: with ladder.margin_px() px around what will be read; it is read again by Band, and must not change
  // meanwhile.
  LadderBlur(const Planes& frame, const LevelLadder& ladder);

  // out[c](y, x) = channel c of the frame, blurred by sigma_px(y, x), at first + (x, y); first counted from
  // the frame's corner, margin included. sigma_px: CV_32FC1, in [0, the ladder's most]; out: as many planes
  // as the frame, of its size. Levels that no sigma of a block of 64 px asks for are not computed there.
  // Any order, any thread, however an image is cut into bands: the same bits.
  void Band(cv::Point first, const cv::Mat& sigma_px, Planes& out) const;

 private:
  Planes frame_;
  MixtureTables tables_;
  std::vector<FineKernel> kernels_;  // [level]
  int most_radius_ = 0;              // of them all
  std::vector<CoarseLevel> coarse_;  // [level]
};

}  // namespace shimmer::sim
