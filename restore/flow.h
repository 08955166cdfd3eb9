// Where each pixel of a frame is in another: dense optical flow, behind one interface.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

namespace shimmer::restore {

class DenseFlow {
 public:
  virtual ~DenseFlow() = default;

  // CV_32FC2, in px of the frames: what is at p of `from` is at p + flow(p) of `to`. Of frames with a side
  // of more than 1,000 px it is computed at half their size, and enlarged. Frames as levels.h takes them, of
  // one size and number of channels; throws std::invalid_argument. Samples beyond black and white count as
  // those.
  cv::Mat Flow(const cv::Mat& from, const cv::Mat& to);

 private:
  // The same of two frames CV_8UC1 or CV_8UC3 (RGB), 16x16 px or more, at their own size.
  virtual cv::Mat Compute(const cv::Mat& from, const cv::Mat& to) = 0;
};

// OpenCV's dense inverse search (Kroeger et al. 2016) on grey. Not for two threads at a time. kFast: its
// preset "fast", which stops at a quarter of the size; kMedium: its preset "medium", for parts of a px.
enum class DisPreset { kFast, kMedium };
std::unique_ptr<DenseFlow> DisFlow(DisPreset preset = DisPreset::kFast);

inline constexpr int kLargeSide_px = 1000;

// Half above kLargeSide_px, else the frame itself: by means of 2x2 px, a last odd row or column left out.
cv::Mat HalvedIfLarge(const cv::Mat& frame);

}  // namespace shimmer::restore
