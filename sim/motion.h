// Where an object is, how large and how turned, at any time of a clip. Times are in frames from the clip's
// first one, and need not be whole: a shutter is open for a while.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "sim/fields.h"

namespace shimmer::sim {

enum class PathKind { kLine, kArc, kSpline, kSway };

struct MotionParams {
  PathKind path = PathKind::kLine;
  double start_x = 0.5, start_y = 0.5;  // of the frame: 0 its left or upper edge, 1 its right or lower one
  double speed_px = 2;
  double direction_deg = 0;
  double radius_px = 100;
  double sway_px = 20, period_frames = 20;
  std::vector<cv::Point2d> points = {};
  double scale_rate = 1;
  double rotation_deg = 0, rotation_rate = 0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(Field{.name = "path",
                .names = {"line", "arc", "spline", "sway"},
                .help =
                    "line and arc: at `speed_px` from `start_x`, `start_y` in `direction_deg`; spline: along "
                    "`points`; sway: to and fro about the start"},
          self.path);
    visit(
        Field{.name = "start_x",
              .low = -4,
              .high = 5,
              .help = "where its centre is in the first frame: 0 is the frame's left edge, 1 its right one"},
        self.start_x);
    visit(Field{.name = "start_y",
                .low = -4,
                .high = 5,
                .help = "the same: 0 is the upper edge, 1 the lower one"},
          self.start_y);
    visit(Field{.name = "speed_px", .unit = "px/frame", .low = 0, .high = 1000, .help = "along the path"},
          self.speed_px);
    visit(Field{.name = "direction_deg",
                .unit = "degrees",
                .low = -360,
                .high = 360,
                .help = "of the first step, or of the sway: 0 is to the right, 90 down"},
          self.direction_deg);
    visit(Field{.name = "radius_px",
                .unit = "px",
                .low = -1e6,
                .high = 1e6,
                .help = "arc: of its circle; it turns clockwise, or the other way where this is negative"},
          self.radius_px);
    visit(Field{.name = "sway_px", .unit = "px", .low = 0, .high = 1000, .help = "sway: to each side"},
          self.sway_px);
    visit(
        Field{
            .name = "period_frames", .unit = "frames", .low = 1, .high = 1e6, .help = "sway: there and back"},
        self.period_frames);
    visit(Field{.name = "points",
                .low = -4,
                .high = 5,
                .help =
                    "spline: [[x, y], ...], at least two, in parts of the frame as start_x and start_y; the "
                    "object stops at the last",
                .per_clip = false},
          self.points);
    visit(Field{.name = "scale_rate",
                .low = 0.5,
                .high = 2,
                .help = "its size is multiplied by this from frame to frame"},
          self.scale_rate);
    visit(Field{.name = "rotation_deg",
                .unit = "degrees",
                .low = -360,
                .high = 360,
                .help = "in the first frame, clockwise"},
          self.rotation_deg);
    visit(
        Field{
            .name = "rotation_rate", .unit = "degrees/frame", .low = -360, .high = 360, .help = "clockwise"},
        self.rotation_rate);
  }
};

struct Pose {
  cv::Point2d centre;  // px of the clip's frame; pixel (0, 0) is the square around (0, 0)
  double scale = 1;
  double turns = 0;  // clockwise on screen
  friend bool operator==(const Pose&, const Pose&) = default;
};

// Where a place of a rigid object is at another pose of it.
cv::Point2d Moved(cv::Point2d place, const Pose& from, const Pose& to);

// Of a frame of this size. Throws std::invalid_argument for a spline of fewer than two points, or an arc of
// radius 0.
class Motion {
 public:
  Motion(const MotionParams& params, cv::Size frame);
  Pose At(double time_frames) const;

 private:
  cv::Point2d PlaceAt(double time_frames) const;
  cv::Point2d OnSpline(double way_px) const;

  MotionParams params_;
  cv::Point2d start_, along_;        // px; unit vector
  std::vector<cv::Point2d> spline_;  // a fine polygon along it, px
  std::vector<double> way_px_;       // to each of its corners
};

}  // namespace shimmer::sim
