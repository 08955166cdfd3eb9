// Where what a reference shows is seen in a frame: what registration asks the optical flow for.
#pragma once

#include <functional>
#include <opencv2/core.hpp>

namespace shimmer::restore {

// from, to: CV_8UC1 of one size. The result is CV_32FC2 of that size, px: from(p) is seen at to(p + flow(p)).
using PairFlow = std::function<cv::Mat(const cv::Mat& from, const cv::Mat& to)>;

// OpenCV's dense inverse search, its preset "medium" (flow.h): "fast" stops at a quarter of the size, where
// most of the turbulence is not to be seen. For one thread at a time.
PairFlow FineFlow();

// A frame and how much each of its px counts.
struct WeighedFrame {
  cv::Mat frame;
  cv::Mat weight;  // CV_8UC1: 0 not at all, 255 fully. Empty: all fully
};

// Throws std::invalid_argument for a frame that is not as Registration takes them, or not of that size and
// type.
void RequireRegistrable(const WeighedFrame& frame, cv::Size size, int type);

// The same as the flow sees it: grey, and at half its size above 1000 px.
struct GreyFrame {
  cv::Mat grey;    // CV_32FC1, in levels, rounded to 1/256: three equal channels are the one, bit by bit
  cv::Mat weight;  // CV_32FC1, in [0, 1]
};
GreyFrame GreyOf(const WeighedFrame& frame);

// What frames are registered to, of the same size.
struct SceneReference {
  cv::Mat grey;   // CV_32FC1, in levels. Empty: there is none
  cv::Mat trust;  // CV_32FC1, in [0, 1]: 0 where the scene is not known, and frames are to stay as they are
};

class ReferenceFlow {
 public:
  ReferenceFlow(SceneReference reference, PairFlow flow);

  // CV_32FC2, px: reference(p) is seen at frame(p + flow(p)), whose light is brought to the reference's by
  // smooth factors before. px of weight 0 are set to the reference: what moves draws none of its surroundings
  // along. Throws std::invalid_argument for a frame of another size.
  cv::Mat To(const GreyFrame& frame) const;

 private:
  cv::Mat Bytes(const cv::Mat& grey) const;

  SceneReference reference_;
  PairFlow flow_;
  double black_ = 0, gain_ = 1;  // of the reference: its range as 8 bits
  cv::Mat bytes_;
};

}  // namespace shimmer::restore
