// A membrane over what a mask covers, held at the mask's edge: the smoothest surface between values that are
// given around it.
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "restore/mask_grid.h"

namespace shimmer::restore {

// u with sum over p's neighbours q of (u(q) - u(p)) = 0 at each px p of `inside`: the four neighbours, those
// on the frame alone, so that at the frame's edge the membrane lies free. Outside of the mask u is given.
class Membrane {
 public:
  // inside: CV_8UC1, not 0 where u is asked for.
  explicit Membrane(const cv::Mat& inside);

  // The px of the mask, and their numbers in Solve's values.
  const std::vector<CellRun>& runs() const { return levels_.front().runs; }

  // around(p): u at a px p beside the mask (channels beyond the frame's 0); may be asked twice for it. The
  // result is off by `tolerance` at most, in u's unit (tests compare it with a direct solution). A mask of
  // everything has nothing to hold it: u is 0.
  //
  // Conjugate gradients, each step led by one cycle through grids of 2, 4, 8, ... px (multigrid: cells that
  // the mask touches, corrections interpolated bilinearly; McAdams et al. 2010 do so for liquids).
  CellValues Solve(const std::function<Sample4(cv::Point)>& around, double tolerance) const;

 private:
  cv::Rect frame_;
  std::vector<MaskGrid> levels_;  // the px first
};

}  // namespace shimmer::restore
