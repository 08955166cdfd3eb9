// A camera that shakes: a translation a frame.
//
// Signs, as truth is written: steady(p) = shaken(p + s), s = (0, 0) in a clip's first frame. So what lies at
// p in the steady frame is seen at p + s.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/draw.h"
#include "sim/fields.h"

namespace shimmer::sim {

enum class Shake { kNone, kWalk, kDrift, kVibration, kList };

inline constexpr std::array<const char*, 5> kShakeNames = {"none", "walk", "drift", "vibration", "list"};

inline constexpr double kMostShake_px = 400;

struct CameraParams {
  Shake shake = Shake::kNone;
  double amplitude_px = 2;
  double correlation_frames = 10;
  double frequency = 0.1;
  double direction_deg = 90;
  double bound_px = 64;
  std::vector<cv::Point2d> shifts = {};
  bool shaken_clean = false;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(Field{.name = "shake",
                .names = {kShakeNames.begin(), kShakeNames.end()},
                .help = "how the camera moves: a random walk, a random drift about its place (an "
                        "Ornstein-Uhlenbeck process), a sine along one direction, or as `shifts` says"},
          self.shake);
    visit(
        Field{.name = "amplitude_px",
              .unit = "px",
              .low = 0,
              .high = kMostShake_px,
              .help = "walk: standard deviation of a frame's step along each axis; drift: of the place along "
                      "each axis; vibration: of the sine, from its middle"},
        self.amplitude_px);
    visit(Field{.name = "correlation_frames",
                .unit = "frames",
                .low = 0.1,
                .high = 1e6,
                .help = "drift: after so many frames the correlation has fallen to 1/e"},
          self.correlation_frames);
    visit(Field{.name = "frequency",
                .unit = "cycles/frame",
                .low = 0,
                .high = 0.5,
                .help = "vibration: of the sine"},
          self.frequency);
    visit(Field{.name = "direction_deg",
                .unit = "degrees",
                .low = -360,
                .high = 360,
                .help = "vibration: 0 is along x, 90 along y"},
          self.direction_deg);
    visit(Field{.name = "bound_px",
                .unit = "px",
                .low = 0,
                .high = kMostShake_px,
                .help =
                    "walk and drift: the most that the camera is off its first place along each axis, where "
                    "it turns back; so much more of the source is needed on each side"},
          self.bound_px);
    visit(Field{.name = "shifts",
                .unit = "px",
                .low = -kMostShake_px,
                .high = kMostShake_px,
                .help = "list: [[x, y], ...], one for each frame, relative to that of the first",
                .per_clip = false},
          self.shifts);
    visit(Field{.name = "shaken_clean",
                .help = "the clean twin shakes as the turbulent one does; else it stands",
                .per_clip = false},
          self.shaken_clean);
  }
};

// The whole px of a shake; the rest is at most half a px along each axis.
inline cv::Point WholeShake(cv::Point2d shake_px) { return {cvRound(shake_px.x), cvRound(shake_px.y)}; }

// The most that |s| may be along x and along y in any clip of these parameters, in whole px, rounded up: so
// much of the source must lie around the crop.
cv::Size ShakeReach(const CameraParams& camera);

// s of each frame, px; exactly (0, 0) in the first. The same whatever `frames` is: a longer clip begins as a
// shorter one. Throws std::invalid_argument for a list shorter than the clip.
std::vector<cv::Point2d> ShakePath(const CameraParams& camera, ClipKey key, int64_t frames);

}  // namespace shimmer::sim
