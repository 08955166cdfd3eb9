// Frames registered to their mean: each moved, px by px, to where the static scene is on average.
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <vector>

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

// out(p) = in(p + flow(p)), flow CV_32FC2 of the frame's size or smaller (then enlarged, and its values with
// it). The frame by cubic interpolation, the weights linearly; the edge goes on beyond.
WeighedFrame Warped(const WeighedFrame& in, const cv::Mat& flow);

struct RegisterParams {
  int first_frames = 15;       // whose mean is the first reference; at least 1
  int frames_a_keyframe = 15;  // after so many frames the mean of all so far is the reference; at least 1
  int memory_frames = 120;     // what the mean forgets after; at least 1
  PairFlow flow = FineFlow();
};

// One flow a frame, and one more a keyframe, from the reference to the frame, both grey and at half their
// size above 1000 px. The mean of the flows, px by px, is what the reference is off by, since tilts have mean
// 0: it is taken off each flow, so that neither the reference's own error nor its choice moves the scene. A
// new keyframe's flow from the one before goes over to that mean. px of weight 0 are set to the reference:
// what moves draws none of its surroundings along.
class Registration {
 public:
  // Throws std::invalid_argument for params outside of their ranges.
  explicit Registration(RegisterParams params = {});

  // The registered frames that are known now, in order: none for the first first_frames - 1, then those of
  // all of them, then one a frame. frame: CV_8U, CV_16U or CV_32F of 1 or 3 channels, 16x16 px or more, of
  // the size and type of the first. Throws std::invalid_argument for others.
  std::vector<WeighedFrame> Next(WeighedFrame frame);

  // After the last frame: those that are still to come, if there were fewer than first_frames.
  std::vector<WeighedFrame> Rest();

 private:
  cv::Mat GreyOf(const WeighedFrame& frame, cv::Mat& weight) const;
  void AddToMean(const WeighedFrame& frame);
  void MakeReference();
  cv::Mat FlowOf(const WeighedFrame& frame) const;
  void AddToMeanFlow(const cv::Mat& flow, double share);

  RegisterParams params_;
  int type_ = -1, scale_ = 1;
  cv::Size size_;
  double frames_ = 0;  // in the mean
  int since_keyframe_ = 0;
  double black_ = 0, gain_ = 1;     // of the first mean: its range as 8 bits
  cv::Mat sum_, weight_;            // CV_32FC1, of the mean
  cv::Mat reference_;               // CV_8UC1
  cv::Mat mean_flow_;               // CV_32FC2
  double flows_ = 0;                // in it
  std::vector<WeighedFrame> held_;  // until there is a reference
};

}  // namespace shimmer::restore
