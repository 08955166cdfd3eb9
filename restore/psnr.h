// Peak signal-to-noise ratio.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

namespace shimmer::restore {

// 10 log10(255^2 / MSE) in dB, MSE the mean over all pixels and channels of the squared difference in levels
// (levels.h). Infinite where the two are equal. A grey frame beside an RGB one counts as three equal
// channels. Throws std::invalid_argument for what are no frames (levels.h) or not of one size.
double Psnr(const cv::Mat& a, const cv::Mat& b);

// The same of the px of regions of a frame (regions.h).
std::vector<std::optional<double>> PsnrIn(const cv::Mat& a, const cv::Mat& b,
                                          std::span<const cv::Mat> regions);

// The same of their Y (LumaLevels), the peak still 255, as Restormer's evaluation has it.
double PsnrY(const cv::Mat& a, const cv::Mat& b);

}  // namespace shimmer::restore
