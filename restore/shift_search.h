// Zero-mean cross-correlation of a frame with a mosaic at all shifts, by FFT.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "restore/mosaic.h"

namespace shimmer::restore {

struct ShiftPeak {
  cv::Point2d shift_px;  // of the level, to a part of a px
  double correlation;    // normalised, over what both see: in [-1, 1]
  double clearness;      // its score, in standard deviations of those that shifts have by chance
};

// The best shifts |x|, |y| <= the mosaic's margin_px, best first, at most `count`, no two neighbours. detail:
// the frame's, of zero mean, as large as the mosaic's frames. Scores are correlation * sqrt(part of the frame
// that the mosaic sees): what is found by chance grows as the overlap shrinks, by that root. Shifts where the
// mosaic sees less than kLeastOverlap of the frame are left out. Empty if the frame or the mosaic is flat.
std::vector<ShiftPeak> BestShifts(const cv::Mat& detail, const Mosaic& mosaic, int count);

inline constexpr double kLeastOverlap = 0.2;

}  // namespace shimmer::restore
