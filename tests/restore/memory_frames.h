// A video in memory.
#pragma once

#include <utility>
#include <vector>

#include "restore/frames.h"

namespace shimmer::restore {

class MemoryFrames : public Frames {
 public:
  explicit MemoryFrames(std::vector<cv::Mat> frames) : frames_(std::move(frames)) {}
  int64_t count() override { return std::ssize(frames_); }
  cv::Mat Read(int64_t frame) override { return frames_.at(static_cast<size_t>(frame)); }

 private:
  std::vector<cv::Mat> frames_;
};

}  // namespace shimmer::restore
