// Parts of a frame that are measured apart: its foreground, say, and the rest.
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

namespace shimmer::restore {

// A region is CV_8UC1 of the frame's size, and is where it is not 0. They may overlap.

// For each region the mean over its px and their channels; nothing for one that is 0 everywhere. values: of
// these rows of the frame, CV_64FC1, a column a sample; asked for several ranges at a time, and the result is
// the same on any number of threads. Throws std::invalid_argument for regions of another size or type.
std::vector<std::optional<double>> MeansIn(cv::Size frame, std::span<const cv::Mat> regions,
                                           const std::function<cv::Mat(cv::Range rows)>& values);

// The smallest rectangle around what is not 0; all 0 where nothing is. As regions are.
cv::Mat BoxAround(const cv::Mat& region);

}  // namespace shimmer::restore
