// What frames are registered to: the mean of frames from all over the video, without what moves in them.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "restore/register.h"

namespace shimmer::restore {

// Frames one after the other; then their mean, twice: each registered to their plain mean, the mean of these
// is sharper and shows the scene in the same place. On three clips of Shimmer's backgrounds were better by
// 0.01 to 0.16 dB for the second. Memory: 5 bytes a px and frame, at half the frames' size above 1000 px.
class SceneReferenceMean {
 public:
  explicit SceneReferenceMean(PairFlow flow = FineFlow());

  // As Registration takes frames. Throws std::invalid_argument for others.
  void Add(const WeighedFrame& frame);

  // A flow a frame. A px is trusted by 4 times the share of the frames that show the scene there, 1 at most,
  // less near px that are not: the mean of few is where their own tilts have put it. Empty if there was no
  // frame.
  SceneReference Result() const;

 private:
  PairFlow flow_;
  cv::Size size_;
  int type_ = -1;
  std::vector<WeighedFrame> frames_;  // CV_32FC1 in levels, and CV_8UC1; reduced
};

}  // namespace shimmer::restore
