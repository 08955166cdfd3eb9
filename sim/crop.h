// The part of a source that a clip shows, with as much around it as the simulation reads.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::sim {

// Pixels of area and of halo_px around it; what lies outside the image is its reflection about the centres of
// the edge pixels (as often as it takes). area may be anywhere in the image.
cv::Mat CropWithHalo(const cv::Mat& image, cv::Rect area, int halo_px);

// The same of the picture resized, of which no more is computed than is shown. samples, resized, errors and
// the result's type: resample.h.
cv::Mat ResizedCropWithHalo(const cv::Mat& samples, cv::Size resized, cv::Rect area, int halo_px);

}  // namespace shimmer::sim
