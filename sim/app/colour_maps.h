// Truth made visible: shifts and sigmas as colours. Values that are not finite show as mid-grey.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::app {

inline constexpr uchar kNotFiniteGrey = 128;

// Shifts as optical flow is shown: hue is direction (red right, yellow-green down, cyan left, violet up),
// saturation is length up to full_scale_px, white is none; longer ones show as full_scale_px. dx_dy:
// CV_32FC2, px. Gives CV_8UC3 RGB. Throws std::invalid_argument for another type or full_scale_px <= 0.
cv::Mat TiltAsColours(const cv::Mat& dx_dy, double full_scale_px);

// Sigmas from dark (low and below) to light (high and above), evenly for the eye (inferno).
// sigma: CV_32FC1. Gives CV_8UC3 RGB. Throws std::invalid_argument for another type or unless low < high.
cv::Mat SigmaAsHeat(const cv::Mat& sigma, double low, double high);

}  // namespace shimmer::app
