// Steady frames without a border: what a frame does not see is taken from its neighbours.
#pragma once

#include <cstdint>
#include <deque>
#include <opencv2/core.hpp>
#include <optional>

#include "restore/stabilise.h"

namespace shimmer::restore {

struct SteadyFrame {
  cv::Mat frame;  // as the camera of the first frame would see it
  cv::Mat own;    // CV_8UC1: 255 where the frame saw it itself, 0 where it is filled: less sure
};

// Frames one after the other, each given out once `ahead` later ones are known. A px that a frame does not
// see is taken from the frame nearest in time that does: of the later ones up to `ahead` away, of the earlier
// ones without limit (of two as near from the earlier). Only frames with Match::kFound lend. A px that none
// of them saw goes on from the frame's own edge. Memory: `ahead` + 2 frames, and 4 bytes a px.
class BorderFill {
 public:
  explicit BorderFill(int ahead = 8);  // 0 or more; else throws std::invalid_argument

  // The frame `ahead` before this one, if there is one. Throws std::invalid_argument for a frame of another
  // size or type than the first, or as Translated does.
  std::optional<SteadyFrame> Next(const cv::Mat& frame, const FrameShift& shift);

  // After the last frame: those that are still to come, in order.
  std::optional<SteadyFrame> Rest();

 private:
  struct Waiting {
    cv::Mat frame;
    cv::Rect own;
    bool lends;
  };

  SteadyFrame Filled();  // the first of those that wait

  int ahead_;
  int given_ = 0;  // frames given out
  std::deque<Waiting> waiting_;
  cv::Mat past_;     // each px as it was last seen
  cv::Mat past_at_;  // CV_32SC1: in which frame; -1: in none
};

}  // namespace shimmer::restore
