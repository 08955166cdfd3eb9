// The blur of a frame, whichever way the plan chose.
#pragma once

#include <optional>

#include "sim/ladder_blur.h"
#include "sim/plan.h"
#include "sim/planes.h"
#include "sim/stack_blur.h"

namespace shimmer::sim {

class FrameBlur {
 public:
  // frame: with plan.margin_px around what will be read. It is read again by Band, and must not change
  // meanwhile.
  FrameBlur(const Planes& frame, const BlurParams& params, const BlurPlan& plan);

  // out[c](y, x) = channel c of the frame, blurred by sigma_px(y, x), at first + (x, y); first counted from
  // the frame's corner, margin included. out: as many planes as the frame, of sigma_px's size. Any order, any
  // thread, however a frame is cut into bands: the same bits.
  void Band(cv::Point first, const cv::Mat& sigma_px, Planes& out) const;

 private:
  LevelChoice level_choice_;
  int margin_px_;
  cv::Mat interleaved_;  // the frame, for the ways other than the ladder
  std::optional<LadderBlur> ladder_;
  std::optional<BlurStack> stack_;
};

}  // namespace shimmer::sim
