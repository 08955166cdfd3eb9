// How well a mask of what moves meets the true one.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace shimmer::restore {

// CV_8UC1, 255 where a mask is at least half of white, else 0. mask: a grey or RGB frame (levels.h; of RGB
// the mean of the channels). Throws std::invalid_argument for others.
cv::Mat MovingPixels(const cv::Mat& mask);

// Pixels of a mask against the true one's; to be added up over frames.
struct MaskCounts {
  int64_t both = 0, only_found = 0, only_true = 0;

  MaskCounts& operator+=(const MaskCounts& other);
  // In [0, 1]. Where nothing is there that could be wrong they are 1: the IoU of two empty masks, the
  // precision of an empty mask that was found, the recall of an empty true one.
  double Iou() const;
  double Precision() const;  // of what was found, how much is true
  double Recall() const;     // of what is true, how much was found
};

// Both as MovingPixels takes them, of one size. Throws std::invalid_argument.
MaskCounts CompareMasks(const cv::Mat& found, const cv::Mat& truth);

}  // namespace shimmer::restore
