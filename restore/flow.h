// Where each pixel of a frame is in another: dense optical flow, behind one interface.
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::restore {

class DenseFlow {
 public:
  virtual ~DenseFlow() = default;

  // CV_32FC2, in px of the frames: what is at p of `from` is at p + flow(p) of `to`. Of frames with a side
  // of more than 1,000 px it is computed at half their size, and enlarged. Frames as levels.h takes them, of
  // one size and number of channels; throws std::invalid_argument. Samples beyond black and white count as
  // those.
  cv::Mat Flow(const cv::Mat& from, const cv::Mat& to);
  // The same from one frame to each of several.
  std::vector<cv::Mat> Flows(const cv::Mat& from, const std::vector<cv::Mat>& to);

 private:
  // The same of two frames CV_8UC1 or CV_8UC3 (RGB), 16x16 px or more, at their own size.
  virtual cv::Mat Compute(const cv::Mat& from, const cv::Mat& to) = 0;
  // (Here, so that a library with another flow needs this header alone.)
  virtual std::vector<cv::Mat> ComputeAll(const cv::Mat& from, const std::vector<cv::Mat>& to) {
    std::vector<cv::Mat> flows;
    for (const cv::Mat& frame : to) flows.push_back(Compute(from, frame));
    return flows;
  }
};

// OpenCV's dense inverse search (Kroeger et al. 2016) on grey. Not for two threads at a time. kFast: its
// preset "fast", which stops at a quarter of the size; kMedium: its preset "medium", for parts of a px.
enum class DisPreset { kFast, kMedium };
std::unique_ptr<DenseFlow> DisFlow(DisPreset preset = DisPreset::kFast);

// Makes a flow for each who asks: a flow is not for two threads at a time.
using FlowMaker = std::function<std::unique_ptr<DenseFlow>()>;
FlowMaker DisFlows();

// OpenCV's flow by the expansion of neighbourhoods in polynomials (Farneback 2003): another, to hold DIS
// against.
FlowMaker FarnebackFlows();

inline constexpr int kLargeSide_px = 1000;

// Half above kLargeSide_px, else the frame itself: by means of 2x2 px, a last odd row or column left out.
cv::Mat HalvedIfLarge(const cv::Mat& frame);

}  // namespace shimmer::restore
