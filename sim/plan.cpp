#include "sim/plan.h"

#include <cmath>
#include <string>

#include "sim/gaussian.h"
#include "sim/level_ladder.h"
#include "sim/warp.h"

namespace shimmer::sim {
namespace {

TiltPlan PlanTilt(const TiltParams& tilt) {
  return {.frozen = tilt.temporal_scale == 0,
          .margin_px = static_cast<int>(std::ceil(tilt.BoundPx())) + kWarpReachPx};
}

// The fastest way within the budget.
BlurWay WayOf(const BlurParams& blur, bool linear_light, const Accuracy& accuracy) {
  if (blur.method == BlurMethod::kStack) return BlurWay::kStack;
  const bool exact =
      blur.method == BlurMethod::kExact ||
      accuracy.max_error_levels < (linear_light ? kLadderErrorLevelsEncoded : kLadderErrorLevels);
  return exact ? BlurWay::kExact : BlurWay::kLadder;
}

BlurPlan PlanBlur(const BlurParams& blur, const std::optional<TiltPlan>& tilt, bool linear_light,
                  const Accuracy& accuracy) {
  BlurPlan plan{.way = WayOf(blur, linear_light, accuracy)};
  plan.margin_px = plan.way == BlurWay::kLadder
                       ? LevelLadder::For(blur.max_sigma_px).margin_px()
                       : GaussianRadius(static_cast<float>(blur.max_sigma_px));  // sigmas are float32
  const bool varies = blur.max_sigma_px > blur.min_sigma_px;
  plan.noise = varies && blur.tilt_weight < 1;
  plan.tilt = varies && blur.tilt_weight > 0 && tilt;
  plan.constant = !plan.noise && !plan.tilt;
  plan.frozen = !(plan.noise && blur.temporal_scale > 0) && !(plan.tilt && !tilt->frozen);
  return plan;
}

}  // namespace

void ClipShape::Validate() const {
  if (size.width < 1 || size.height < 1 || frames < 1)
    throw std::invalid_argument("clip of " + std::to_string(frames) + " frames of " +
                                std::to_string(size.width) + "x" + std::to_string(size.height) +
                                " px, must be at least 1 frame of 1x1");
  if (first_frame < 0 || first_frame + frames > (int64_t{1} << 31))
    throw std::invalid_argument("first_frame = " + std::to_string(first_frame) +
                                ", must be in [0, 2^31 - frames]");
}

ClipPlan PlanClip(const Scene& scene, const ClipShape& shape, const Accuracy& accuracy) {
  scene.Validate();
  shape.Validate();
  accuracy.Validate();
  ClipPlan plan;
  plan.shape = shape;
  plan.linear_light = scene.colour == Colour::kLinear;
  plan.read_once = scene.still;
  if (scene.tilt.strength_px > 0) plan.tilt = PlanTilt(scene.tilt);
  if (scene.blur.max_sigma_px > 0) plan.blur = PlanBlur(scene.blur, plan.tilt, plan.linear_light, accuracy);
  plan.render_once = scene.still && (!plan.tilt || plan.tilt->frozen) && (!plan.blur || plan.blur->frozen);
  plan.halo_px = (plan.tilt ? plan.tilt->margin_px : 0) + (plan.blur ? plan.blur->margin_px : 0);
  return plan;
}

}  // namespace shimmer::sim
