// A frame moved by a shift: whole px are copied, fractions resampled.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::restore {

// out(p) = frame(p + shift_px), of the frame's size and type (CV_8U, CV_16U or CV_32F, any channels).
// Fractions of a px by Lanczos' kernel of three lobes, weights of sum 1, rounded once: constants stay, and
// where shift_px is whole the bits are copied. Beyond the frame its nearest edge goes on. Fractions are taken
// to the nearest 1/1024 px. Throws std::invalid_argument for an empty frame, another type, or a shift that is
// not finite.
cv::Mat Translated(const cv::Mat& frame, cv::Point2d shift_px);

// Where of a frame of this size Translated shows its own pixels, and not its edge: the px p with p + shift_px
// on the frame. May be empty.
cv::Rect SeenArea(cv::Size size, cv::Point2d shift_px);

}  // namespace shimmer::restore
