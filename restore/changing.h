// Bars around a picture that never change: letterboxes, black frames, what is burnt into them. They need no
// work, and must not be taken for a scene that stands while the camera shakes.
#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "restore/frames.h"

namespace shimmer::restore {

struct Changing {
  cv::Rect area;  // of the frames: the picture in it; all of it where there are no bars
  cv::Mat first;  // the first frame, whole: where the bars come from. Empty where there are none
};

// A bar is what lies beyond all changes on a side of the frame, every bit as in the first frame, and is for
// the most part of one colour: a scene with texture that stands bit by bit is none, since it tells that the
// camera stood. All of the frame where its bars are less than a twentieth of it, or nothing changes. Stops to
// read once enough has changed, which is mostly in the second frame. step: called after each read. Throws
// what reading throws.
Changing FindChanging(Frames& video, const std::function<void()>& step);

// A video without its bars. Both must outlive it.
class Inside : public Frames {
 public:
  Inside(Frames& video, cv::Rect area) : video_(video), area_(area) {}
  int64_t count() override { return video_.count(); }
  cv::Mat Read(int64_t frame) override;

 private:
  Frames& video_;
  cv::Rect area_;
};

}  // namespace shimmer::restore
