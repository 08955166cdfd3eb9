// Frames registered to a scene, or to their mean: each moved, px by px, to where the static scene is on
// average.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "restore/reference_flow.h"

namespace shimmer::restore {

// out(p) = in(p + flow(p)), flow CV_32FC2 of the frame's size or smaller (then enlarged, and its values with
// it). The frame by cubic interpolation, the weights linearly; the edge goes on beyond.
WeighedFrame Warped(const WeighedFrame& in, const cv::Mat& flow);

struct RegisterParams {
  SceneReference scene = {};   // to register to, the same for all frames; empty: to their mean
  int first_frames = 15;       // whose mean is the first reference; at least 1
  int frames_a_keyframe = 15;  // after so many frames the mean of all so far is the reference; at least 1
  int memory_frames = 120;     // what the mean forgets after; at least 1
  PairFlow flow = FineFlow();
};

// One flow a frame, from the scene or from the mean of the frames so far, both grey and at half their size
// above 1000 px.
//
// A scene stands: nothing is held back, and what its flows have in common is left in them, as it is what the
// frames are off by. The mean of few frames is itself off: the mean of its flows, px by px, is taken off each
// flow, since tilts have mean 0, so that neither its own error nor its choice moves the scene. There is one
// flow more a keyframe, whose flow from the one before goes over to that mean.
class Registration {
 public:
  // Throws std::invalid_argument for params outside of their ranges.
  explicit Registration(RegisterParams params = {});

  // The registered frames that are known now, in order: one a frame; without a scene none for the first
  // first_frames - 1, then those of all of them. frame: CV_8U, CV_16U or CV_32F of 1 or 3 channels, 16x16 px
  // or more, of the size and type of the first, and of the scene's size. Throws std::invalid_argument for
  // others.
  std::vector<WeighedFrame> Next(WeighedFrame frame);

  // After the last frame: those that are still to come, if there were fewer than first_frames.
  std::vector<WeighedFrame> Rest();

 private:
  void AddToMean(const GreyFrame& frame);
  void MakeReference();
  void AddToMeanFlow(const cv::Mat& flow, double share);

  RegisterParams params_;
  int type_ = -1;
  cv::Size size_;
  std::optional<ReferenceFlow> reference_;
  // Of the mean, where there is no scene:
  double frames_ = 0;  // in it
  int since_keyframe_ = 0;
  cv::Mat sum_, weight_;            // CV_32FC1
  cv::Mat mean_flow_;               // CV_32FC2
  double flows_ = 0;                // in it
  std::vector<WeighedFrame> held_;  // until there is a reference
};

}  // namespace shimmer::restore
