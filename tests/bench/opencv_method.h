// The step as one would write it with OpenCV alone, for comparison: cv::remap with INTER_CUBIC and its 1/32
// px tables, 11 copies of the frame blurred by cv::GaussianBlur with evenly spaced sigmas (the first is the
// frame itself), and for each pixel the linear mixture of the two copies around its sigma. Shifts and sigmas
// are given: OpenCV has no noise.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::bench {

// out pixel = clean at (x + margin_px + dx, y + margin_px + dy). dx, dy: CV_32F; clean: 8 bit or float.
cv::Mat OpenCvWarp(const cv::Mat& clean, int margin_px, const cv::Mat& dx, const cv::Mat& dy);

// frame has border_px around the area of sigma (CV_32F), which is the result's.
cv::Mat OpenCvBlur(const cv::Mat& frame, int border_px, const cv::Mat& sigma, double max_sigma_px);

// The double twin of remap's cubic interpolation (whose kernel has a = -0.75, where Catmull-Rom has -0.5) at
// (x, y) of a plane, CV_32FC1.
double OpenCvCubicDouble(const cv::Mat& plane, double x, double y);

}  // namespace shimmer::bench
