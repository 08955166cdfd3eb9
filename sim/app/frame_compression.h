// A camera's compression of the turbulent frames of a clip, in their order.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "sim/app/config/config.h"
#include "sim/dataset/compression.h"

namespace shimmer::app {

class FrameCompression {
 public:
  explicit FrameCompression(const Config& config) : config_(config) {}

  // samples: the output's. What is left of them when they are decoded again, of the same type: of 8 bits (of
  // sRGB where the output is linear light). The frame itself where nothing is compressed.
  cv::Mat Through(const cv::Mat& samples);

 private:
  const Config& config_;
  std::optional<dataset::H264Stream> stream_;  // begins with the first frame
};

}  // namespace shimmer::app
