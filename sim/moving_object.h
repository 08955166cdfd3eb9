// An object that moves over a scene: what it looks like, and its path.
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <variant>

#include "sim/cutout.h"
#include "sim/layer.h"
#include "sim/motion.h"
#include "sim/shapes.h"

namespace shimmer::sim {

// A drawn shape of a colour; a cut-out; or one for each frame of the clip, counted from its first (a video
// and its masks).
struct DrawnLook {
  Shape shape;
  cv::Vec3f colour;  // [0, 1], of the light that the clip works in
};
using StillLook = std::shared_ptr<const Cutout>;
using VideoLook = std::function<std::shared_ptr<const Cutout>(int64_t frame)>;
using Look = std::variant<DrawnLook, StillLook, VideoLook>;

class MovingObject {
 public:
  // height_px: in the first frame. shutter: the share of a frame's time that light is gathered, [0, 1],
  // around the frame's own time. frame: the clip's size, frames: its length. Throws as Motion.
  MovingObject(Look look, const MotionParams& motion, cv::Size frame, int64_t frames, double height_px,
               double shutter);

  // Frame k of the clip, counted from its first: light and coverage, means over the shutter's time, of what
  // lies within an area. A walker makes a stride while it goes 0.9 of its height. A drawn shape whose path
  // begins to the left faces left.
  Layer At(int64_t k, cv::Rect within = kEverywhere) const;

  // Of each pixel of an area: the way, px, of what is seen there at frame k's own time to where it is at that
  // of the next. CV_32FC2; NaN where less than half of the pixel is covered. Of a video the picture's own
  // motion is not known, and left out.
  cv::Mat FlowAt(int64_t k, cv::Rect area) const;

 private:
  Layer Snapshot(double time_frames, int64_t frame, cv::Rect within) const;
  std::vector<ShapePart> PartsAt(const DrawnLook& look, double time_frames) const;
  const Cutout* CutoutAt(int64_t frame, std::shared_ptr<const Cutout>& keeper) const;
  int SnapshotsAt(int64_t k) const;

  Look look_;
  Motion motion_;
  double speed_px_, height_px_, shutter_;
  bool faces_left_;
};

}  // namespace shimmer::sim
