// What a clip needs, decided once. Absent means skipped: this is the only place that asks what a scene is
// like, and the renderer does what the plan says. A plan is a value: `shimmer plan` prints it, the manifest
// keeps it, tests compare it.
#pragma once

#include <algorithm>
#include <opencv2/core.hpp>
#include <optional>

#include "noise/field_plan.h"
#include "sim/level_ladder.h"
#include "sim/scene.h"

namespace shimmer::sim {

struct ClipShape {
  cv::Size size;  // px
  int frames = 1;
  int64_t first_frame = 0;

  void Validate() const;  // throws std::invalid_argument
  friend bool operator==(const ClipShape&, const ClipShape&) = default;
};

struct TiltPlan {
  bool frozen = false;          // one field serves all frames
  int margin_px = 0;            // how far outside itself a pixel may be taken from, interpolation included
  noise::FieldPlan field = {};  // how each axis is evaluated; errors in px

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(Field{.name = "frozen", .help = "one field serves all frames"}, self.frozen);
    visit(
        Field{.name = "margin_px", .unit = "px", .help = "how far outside itself a pixel may be taken from"},
        self.margin_px);
    visit(Field{.name = "field", .unit = "px", .help = "how each octave is evaluated, and the error of that"},
          self.field);
  }
  friend bool operator==(const TiltPlan&, const TiltPlan&) = default;
};

// exact: each pixel's own Gaussian (exact_blur.h). ladder: mixtures of blurred copies, within its grade's
// promise (ladder_blur.h). stack: the paper's 11 copies, with no promise (stack_blur.h).
enum class BlurWay { kExact, kLadder, kStack };

struct BlurPlan {
  BlurWay way = BlurWay::kExact;
  LadderGrade grade = LadderGrade::kStandard;  // of the ladder
  bool constant = false;                       // one sigma everywhere: no map
  bool noise = false;                          // the map has a Perlin part
  bool tilt = false;                           // the map has a tilt part
  bool frozen = false;                         // one map serves all frames
  double least_sigma_px = 0;                   // that the map may have: objects scale it
  int margin_px = 0;                           // px around a pixel that its value is gathered from
  noise::FieldPlan field = {};                 // how the Perlin part is evaluated; errors in the noise's unit
  double promised_levels = 0;  // RMS error on a natural picture, in 1/255: of a ladder, and of sigma

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(Field{.name = "way", .names = {"exact", "ladder", "stack"}, .help = "how the Gaussian is computed"},
          self.way);
    visit(Field{.name = "grade", .names = {"fine", "standard", "coarse"}, .help = "how near a ladder comes"},
          self.grade);
    visit(Field{.name = "constant", .help = "one sigma everywhere: no map"}, self.constant);
    visit(Field{.name = "noise", .help = "the map has a Perlin part"}, self.noise);
    visit(Field{.name = "tilt", .help = "the map has a tilt part"}, self.tilt);
    visit(Field{.name = "frozen", .help = "one map serves all frames"}, self.frozen);
    visit(Field{.name = "least_sigma_px", .unit = "px", .help = "that the map may have: objects scale it"},
          self.least_sigma_px);
    visit(
        Field{.name = "margin_px", .unit = "px", .help = "px around a pixel that its value is gathered from"},
        self.margin_px);
    visit(Field{.name = "field", .help = "how each octave of the Perlin part is evaluated"}, self.field);
    visit(Field{.name = "promised_levels",
                .unit = "1/255",
                .help = "RMS error on a natural picture: of a ladder, and of sigma"},
          self.promised_levels);
  }
  friend bool operator==(const BlurPlan&, const BlurPlan&) = default;
};

struct ShakePlan {
  int reach_x_px = 0, reach_y_px = 0;  // how far the camera may be off its first place

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(
        Field{.name = "reach_x_px", .unit = "px", .help = "how far the camera may be off its place along x"},
        self.reach_x_px);
    visit(Field{.name = "reach_y_px", .unit = "px", .help = "the same along y"}, self.reach_y_px);
  }
  friend bool operator==(const ShakePlan&, const ShakePlan&) = default;
};

struct ClipPlan {
  ClipShape shape;
  std::optional<TiltPlan> tilt;    // absent: no noise, no warp
  std::optional<BlurPlan> blur;    // absent: no blur
  std::optional<ShakePlan> shake;  // absent: the camera stands
  int objects = 0;                 // that are composed into each frame
  bool own_distances = false;      // tilt and sigma are scaled where an object is seen
  bool linear_light = false;       // decode sRGB before, encode after
  bool sensor = false;             // every pixel passes through it
  Compression compression = Compression::kNone;
  bool read_once = false;    // the source is a still
  bool render_once = false;  // nothing moves: every frame is the first one
  int halo_px = 0;           // px around what the camera sees that turbulence and interpolation read

  // How far outside itself a pixel may be taken from, shake's whole px aside.
  int WarpMargin() const;
  // Px of the steady frame that are read around the crop over all frames.
  int AroundPx() const { return halo_px + (shake ? std::max(shake->reach_x_px, shake->reach_y_px) : 0); }
  // All that is read of the steady frames of the clip; (0, 0) is the crop's first pixel.
  cv::Rect Area() const {
    const int around_px = AroundPx();
    return {-around_px, -around_px, shape.size.width + 2 * around_px, shape.size.height + 2 * around_px};
  }
  // What is read of the steady frame for a frame of this shake.
  cv::Rect Window(cv::Point2d shake_px) const;

  friend bool operator==(const ClipPlan&, const ClipPlan&) = default;
};

// Throws std::invalid_argument where scene, shape or accuracy are out of their ranges.
ClipPlan PlanClip(const Scene& scene, const ClipShape& shape, const Accuracy& accuracy);

}  // namespace shimmer::sim
