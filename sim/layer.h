// A picture that covers part of a frame: light times coverage, and the coverage.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::sim {

struct Layer {
  cv::Rect area;  // px of the clip's frame; may lie outside of it
  cv::Mat rgba;   // CV_32FC4 of that size: red, green and blue times alpha, and alpha, in [0, 1]
};

// The layer over a frame whose pixel (0, 0) is pixel `origin` of the clip's: frame = rgb + (1 - alpha) frame,
// mask = alpha + (1 - alpha) mask. frame: CV_32FC3, or CV_32FC1 (the mean of the layer's three); mask:
// CV_32FC1 of its size. What lies outside of the frame is left out. Throws std::invalid_argument for other
// types.
void Composite(const Layer& layer, cv::Point origin, cv::Mat& frame, cv::Mat& mask);

// The mean of layers that an object has at several times: motion blur. At least one.
class LayerMean {
 public:
  void Add(const Layer& layer);
  Layer Mean() const;

 private:
  Layer sum_;
  int layers_ = 0;
};

}  // namespace shimmer::sim
