// The paper's way to stabilise, as it prints it: to compare with.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::bench {

// s of each frame (steady(p) = shaken(p + s)), whole px: where the cross-correlation of the first frame with
// each frame less a border has its maximum, both less the mean of the whole video. frames: CV_32FC1 of one
// size, larger than the border twice. Not normalised, first frame as reference throughout.
std::vector<cv::Point2d> PlainShifts(const std::vector<cv::Mat>& frames, int border_px);

}  // namespace shimmer::bench
