// The static scene of a video: each frame's background as the mean of the frames around it.
#pragma once

#include <deque>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "restore/border_fill.h"
#include "restore/register.h"
#include "restore/turbulence_strength.h"

namespace shimmer::restore {

enum class Register { kAuto, kOn, kOff };

struct BackgroundParams {
  // Frames on either side of one that count with it, in [0, 100]; at the ends of the video as many more on
  // the other side, if there are. Their weights are those of a Gaussian of sigma = ahead frames. 0: each
  // frame by itself.
  int ahead = 14;
  bool registered = false;    // before the mean is taken (register.h)
  bool lucky = false;         // px count by how sharp a frame is there (luck.h)
  SceneReference scene = {};  // to this; empty: to their mean
  PairFlow flow = FineFlow();
};

// The stated rule. The window grows with the tilt, from 1 frame where there is none to 29 (ahead = 14) where
// its root mean square along an axis is 0.3 px or more: on 80 clips of Shimmer's, half of them with things
// that move, as many from 1 px on gained 0.17 dB less. Frames are registered (kAuto) where it is 0.25 px or
// more: that gave 0.15 dB at 0.25 px, but 0.03 dB at 0.12 px.
BackgroundParams BackgroundFor(const TurbulenceStrength& strength, Register registered);

struct BackgroundFrame {
  cv::Mat frame;  // of the frames' type; shared, and not to be written to
  cv::Mat seen;   // CV_8UC1: 255; 0 where no frame so far saw the static scene
};

// Frames one after the other, each one's background given out once `ahead` later ones are known, and the
// first once 2 `ahead` are. Memory: 2 ahead + 1 frames in their own depth, however many there are.
//
// A px is the sum of the window's samples times their weights, over the sum of these weights: the Gaussian's,
// times the share that does not move, times 1/4 where the frame was filled (border_fill.h), and, if wanted,
// times how lucky the frame is there beside the others (least within 12 px of what moves or is filled). Where
// the window's frames see less than a quarter of what they could, what is missing to that quarter is taken
// from the background before: so a px that stays hidden keeps what was last seen of it. A px that no frame so
// far saw is the mean of the frames as they are (what hides it, that is), and not `seen`.
class Background {
 public:
  // Throws std::invalid_argument for params outside of their ranges.
  explicit Background(BackgroundParams params = {});

  // Where no frame so far sees a px it is taken from here, as if it were the background before the first: of
  // a look at the video before. Before the first frame, of its size and type; else throws
  // std::invalid_argument.
  void StartFrom(const cv::Mat& background);

  // The backgrounds that are known now, in order: those of the first ahead + 1 frames at once, then that of
  // the frame `ahead` before this one. steady.frame: CV_8U, CV_16U or CV_32F of 1 or 3 channels, of the size
  // and type of the first; steady.own may be empty: all its own.
  // moving: CV_8UC1 of that size, 255 where something moves, between where that is not sure; empty: nothing
  // moves. Throws std::invalid_argument for others. The same on any number of threads.
  std::vector<BackgroundFrame> Next(const SteadyFrame& steady, const cv::Mat& moving = {});

  // After the last frame: those that are still to come, in order.
  std::optional<BackgroundFrame> Rest();

 private:
  struct Waiting {
    WeighedFrame seen;
    std::vector<unsigned char> full;  // by row and piece of a row: all weights are 255
    cv::Mat luck;                     // LuckOf the frame, where wanted
  };

  void Add(WeighedFrame frame, std::vector<BackgroundFrame>& known);
  BackgroundFrame Mean() const;  // of the frame that is next to be given out
  BackgroundFrame Given();

  BackgroundParams params_;
  std::vector<float> gaussian_;  // by distance in frames
  std::optional<Registration> registration_;
  std::deque<Waiting> window_;
  size_t at_ = 0;  // in the window: the frame that is next to be given out
  int type_ = -1;
  cv::Size size_;
  BackgroundFrame before_;
};

}  // namespace shimmer::restore
