// Structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004), as three programs define it.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

namespace shimmer::restore {

// All are means over pixels and channels of
//   (2 ma mb + C1) (2 cab + C2) / ((ma^2 + mb^2 + C1) (va + vb + C2)),  C1 = (0.01 255)^2, C2 = (0.03 255)^2
// with the window's means m, variances v and covariance c in levels (levels.h). 1 where the two are equal. A
// grey frame beside an RGB one counts as three equal channels. In double; frames of any size. They throw
// std::invalid_argument for what are no frames or not of one size.

// As OpenCV's samples: a Gaussian window of 11x11 px, sigma 1.5; all pixels count, what lies beyond the
// border is its reflection (BORDER_REFLECT_101).
double SsimOpenCv(const cv::Mat& a, const cv::Mat& b);

// The same of the px of regions of a frame (regions.h), whose windows see what is around them too.
std::vector<std::optional<double>> SsimIn(const cv::Mat& a, const cv::Mat& b,
                                          std::span<const cv::Mat> regions);

// As scikit-image's structural_similarity by default, with data_range=255 (channel_axis=-1 for RGB): a flat
// window of 7x7 px, sample variance (divided by 48); pixels less than 3 px from the border do not count.
// Nothing for frames of less than 7 px along a side.
std::optional<double> SsimScikitImage(const cv::Mat& a, const cv::Mat& b);

// Of their Y (LumaLevels), as Restormer's evaluation: a Gaussian window of 11x11 px, sigma 1.5; all pixels
// count, beyond the border the outermost go on (BORDER_REPLICATE). (BasicSR leaves the outermost 5 px out.)
double SsimY(const cv::Mat& a, const cv::Mat& b);

}  // namespace shimmer::restore
