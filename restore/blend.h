// What moves, laid into a restored background without a seam: Poisson blending.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::restore {

// How far the frame's light may be off the background's, in each channel.
inline constexpr float kMostOffset_levels = 16;

// The picture that is the background where mask is 0 and has the frame's gradients where it is 255: the frame
// plus the smoothest surface that meets background - frame around the mask (Perez et al. 2003 as a membrane,
// membrane.h), so that an offset between both vanishes. Where the mask is unsure the two are mixed by it:
// background + mask / 255 * (frame + membrane - background). An empty mask gives the background, bit by bit,
// a mask of every px the frame (there is nothing to meet).
//
// A px beside the mask where they differ by more, or are not finite, shows something that the mask cuts. It
// pulls as if both were equal: else the object's own colour would be taken off what is left of it.
//
// frame, background: CV_8U, CV_16U or CV_32F of 1 or 3 channels, of one size and type, which the result has
// too; rounded once, within 0.1 level (levels.h) of the exact solution. mask: CV_8UC1 of that size. Throws
// std::invalid_argument for others.
cv::Mat Blended(const cv::Mat& frame, const cv::Mat& background, const cv::Mat& mask);

}  // namespace shimmer::restore
