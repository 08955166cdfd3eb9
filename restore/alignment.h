// Fits frames to the mosaic of those before: both of a frame's levels, and the search through them.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "restore/block_shift.h"
#include "restore/mosaic.h"

namespace shimmer::restore {

struct FrameDetail {
  cv::Mat fine, coarse;  // Detail::values of both levels; the same where there is but one
};

struct Fit {
  cv::Point2d fine_px;     // s, px of the fine level
  double correlation = 0;  // with the mosaic's fine level, over what both see
  double clearness = 0;    // ShiftPeak's
  CommonShift common;      // of the last step: its scatter and error are those of the shift
};

class Alignment {
 public:
  // The levels' frame sizes, what one coarse px is in fine ones, and the most |s| in coarse px.
  Alignment(cv::Size fine, cv::Size coarse, int ratio, int margin_px);

  Alignment Empty() const;  // another one like it, without frames

  void Add(const FrameDetail& detail, cv::Point2d fine_px);

  // The best of all shifts; none if nothing fits at all.
  std::optional<Fit> Search(const FrameDetail& detail) const;

  // From a shift that is good to a fine px or two; none if it leads off the canvas, or nothing there has
  // texture. Where the frame itself has been added, at `added_px`, it is not compared with itself.
  std::optional<Fit> Refined(const cv::Mat& fine_detail, cv::Point2d from_px,
                             std::optional<cv::Point2d> added_px = {}) const;

 private:
  int ratio_, margin_px_;
  cv::Size fine_size_, coarse_size_;
  Mosaic fine_, coarse_;
};

// Frames that have been fitted one after the other, fitted to the mean of all others again and again until
// none moves: the first of them had little to go by, and what moved with an object at first moved the mosaic
// along. In the first frame s stays (0, 0). alignment is left with exactly these frames. details and fits: of
// one length, at least 1.
void AlignTogether(const std::vector<FrameDetail>& details, std::vector<Fit>& fits, Alignment& alignment);

}  // namespace shimmer::restore
