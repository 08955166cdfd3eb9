// Where an object is, how large and how turned, at any time of a clip. Times are in frames from the clip's
// first one, and need not be whole: a shutter is open for a while.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/fields.h"

namespace shimmer::sim {

enum class PathKind { kLine, kArc, kSpline, kSway };
enum class OffFrame { kRefuse, kShift, kAllow };

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
  OffFrame off_frame = OffFrame::kRefuse;

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
    visit(Field{.name = "off_frame",
                .names = {"refuse", "shift", "allow"},
                .help = "where its middle would leave the frame: refuse is an error, shift moves the whole "
                        "path by as little as keeps it within, allow lets it go",
                .per_clip = false},
          self.off_frame);
  }
};

struct Pose {
  cv::Point2d centre;  // px of the clip's frame; pixel (0, 0) is the square around (0, 0)
  double scale = 1;    // [e^-14, e^14]: an object of more than all frames, or less than a pixel
  double turns = 0;    // clockwise on screen
  friend bool operator==(const Pose&, const Pose&) = default;
};

// What carries the places of a rigid object from one pose of it to another.
struct Carry {
  Carry(const Pose& from, const Pose& to);
  Carry(cv::Point2d from_, cv::Point2d to_, cv::Point2d turn_) : from(from_), to(to_), turn(turn_) {}

  cv::Point2d operator()(cv::Point2d place) const {
    const cv::Point2d off = place - from;
    return to + cv::Point2d(off.x * turn.x - off.y * turn.y, off.x * turn.y + off.y * turn.x);
  }

  cv::Point2d from, to;  // its middle
  cv::Point2d turn;      // where (1, 0) points then, times the change of scale
};

// Where a place of it is at the other pose.
inline cv::Point2d Moved(cv::Point2d place, const Pose& from, const Pose& to) {
  return Carry(from, to)(place);
}

// Over a frame of this size, of a clip of so many frames. Throws std::invalid_argument for a spline of fewer
// than two points, an arc of radius 0, and a path that leaves the frame where off_frame forbids it, or is too
// long to be shifted into it.
class Motion {
 public:
  Motion(const MotionParams& params, cv::Size frame, int64_t frames);
  Pose At(double time_frames) const;

  // Whether its first step goes to the left rather than up, down, to the right or nowhere.
  bool BeginsLeftward() const;

 private:
  cv::Point2d PlaceAt(double time_frames) const;
  void DrawSpline(cv::Size frame);
  void KeepWithin(cv::Size frame, int64_t frames);
  cv::Point2d OnSpline(double way_px) const;

  MotionParams params_;
  cv::Point2d start_, along_;        // px; unit vector
  cv::Point2d shift_;                // px, of the whole path
  std::vector<cv::Point2d> spline_;  // a fine polygon along it, px
  std::vector<double> way_px_;       // to each of its corners
};

}  // namespace shimmer::sim
