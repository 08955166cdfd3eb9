#include "sim/plan.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "noise/portable_math.h"
#include "sim/error_budget.h"
#include "sim/field_plan.h"
#include "sim/gaussian.h"
#include "sim/level_ladder.h"
#include "sim/warp.h"

namespace shimmer::sim {
namespace {

// What an RMS error of linear light grows to when it is encoded as sRGB: as measured of the ladders, on a
// photograph darkened to its square.
constexpr double kEncodedPerStored = 3.4;

// Whether a blur of this sigma can be seen: what it changes is a pixel's four neighbours' share, exp(-1 / (2
// sigma^2)), of their difference from it, which is at most 65/255 RMS on photographs. At the exact budget,
// where it does not reach a float's last bit. Above half a px, more than the nearest have a share.
bool IsVisible(const BlurParams& blur, bool linear_light, const Accuracy& accuracy) {
  constexpr double kDifferenceLevels = 65, kLastBit = 0x1p-27, kMostInvisible_px = 0.5;
  const double sigma_px = blur.max_sigma_px;
  if (sigma_px <= 0 || sigma_px >= kMostInvisible_px) return sigma_px > 0;
  const double share = noise::Exp(-0.5 / (sigma_px * sigma_px));
  const double levels = share * kDifferenceLevels * (linear_light ? kEncodedPerStored : 1);
  return share > kLastBit && (blur.method != BlurMethod::kAuto || levels > accuracy.max_error_levels);
}

TiltPlan PlanTilt(const TiltParams& tilt) {
  return {.frozen = tilt.temporal_scale == 0,
          .margin_px = static_cast<int>(std::ceil(tilt.BoundPx())) + kWarpReachPx};
}

// What blurring may cost, and what is left of it for sigma.
struct BlurChoice {
  BlurWay way;
  LadderGrade grade = LadderGrade::kStandard;
  double promised_levels = 0;
};

// The fastest way within the budget. A share of it must be left for the sigma map.
BlurChoice ChooseWay(const BlurParams& blur, bool linear_light, const Accuracy& accuracy) {
  constexpr double kLadderShare = 0.9;
  if (blur.method == BlurMethod::kStack) return {BlurWay::kStack};
  if (blur.method == BlurMethod::kAuto)
    for (const LadderGrade grade : {LadderGrade::kCoarse, LadderGrade::kStandard, LadderGrade::kFine}) {
      const LadderPromise promise = PromiseOf(grade);
      const double levels = linear_light ? promise.levels_encoded : promise.levels;
      if (levels <= kLadderShare * accuracy.max_error_levels) return {BlurWay::kLadder, grade, levels};
    }
  return {BlurWay::kExact};
}

BlurPlan PlanBlur(const BlurParams& blur, const ClipPlan& clip, const BlurChoice& choice) {
  const std::optional<TiltPlan>& tilt = clip.tilt;
  BlurPlan plan{.way = choice.way, .grade = choice.grade};
  plan.margin_px = plan.way == BlurWay::kLadder
                       ? LevelLadder::For(blur.max_sigma_px, plan.grade).margin_px()
                       : GaussianRadius(static_cast<float>(blur.max_sigma_px));  // sigmas are float32
  plan.least_sigma_px = clip.own_distances ? 0 : blur.min_sigma_px;
  const bool varies = blur.max_sigma_px > blur.min_sigma_px;
  plan.noise = varies && blur.tilt_weight < 1;
  plan.tilt = varies && blur.tilt_weight > 0 && tilt;
  plan.constant = !plan.noise && !plan.tilt && !clip.own_distances;
  plan.frozen = !(plan.noise && blur.temporal_scale > 0) && !(plan.tilt && !tilt->frozen);
  return plan;
}

// What the ladder leaves of the levels to the sigma map.
double LevelsForSigma(const BlurChoice& choice, bool linear_light, double max_error_levels) {
  const double left = max_error_levels * max_error_levels - choice.promised_levels * choice.promised_levels;
  return std::sqrt(std::max(left, 0.0)) / (linear_light ? kEncodedPerStored : 1);
}

// The ladder's error and that of the sigma map, as fields are planned to make it.
double PromisedLevels(const Scene& scene, const ClipPlan& plan, double ladder_levels) {
  const double encoded = plan.linear_light ? kEncodedPerStored : 1;
  const double noise =
      plan.blur->noise ? plan.blur->field.rms_error * LevelsPerNoise(scene.blur, plan.shape.size) : 0;
  const double tilt =
      plan.blur->tilt ? plan.tilt->field.rms_error * LevelsPerTiltPx(scene, plan.shape.size) : 0;
  return std::hypot(ladder_levels, encoded * noise, encoded * tilt);
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

int ClipPlan::WarpMargin() const {
  const int reach_px = tilt ? tilt->margin_px : shake ? kWarpReachPx : 0;
  return reach_px + (shake ? 1 : 0);  // the shake's fraction of a px
}

cv::Rect ClipPlan::Window(cv::Point2d shake_px) const {
  const cv::Point whole = WholeShake(shake_px);
  return {-whole.x - halo_px, -whole.y - halo_px, shape.size.width + 2 * halo_px,
          shape.size.height + 2 * halo_px};
}

ClipPlan PlanClip(const Scene& scene, const ClipShape& shape, const Accuracy& accuracy) {
  scene.Validate();
  shape.Validate();
  accuracy.Validate();
  ClipPlan plan;
  plan.shape = shape;
  plan.linear_light = scene.colour == Colour::kLinear;
  plan.sensor = scene.sensor.On();
  plan.compression = scene.sensor.compression;
  plan.objects = scene.objects;
  plan.own_distances = scene.own_distances;
  if (const cv::Size reach = ShakeReach(scene.camera); reach.width > 0 || reach.height > 0)
    plan.shake = ShakePlan{reach.width, reach.height};
  plan.read_once = scene.still;
  if (scene.tilt.strength_px > 0) plan.tilt = PlanTilt(scene.tilt);
  SigmaBudget budget;
  double promised_levels = 0;  // of the ladder
  if (IsVisible(scene.blur, plan.linear_light, accuracy)) {
    const BlurChoice choice = ChooseWay(scene.blur, plan.linear_light, accuracy);
    plan.blur = PlanBlur(scene.blur, plan, choice);
    promised_levels = choice.promised_levels;
    const double levels = LevelsForSigma(choice, plan.linear_light, accuracy.max_error_levels);
    budget = ShareLevels(scene, *plan.blur, shape.size, levels);
    if (plan.blur->noise)
      plan.blur->field = PlanBlurNoise(scene.blur, shape.size, shape.frames, budget.noise);
  }
  if (plan.tilt)
    plan.tilt->field =
        PlanTiltField(scene.tilt, shape.size, shape.frames, {accuracy.max_error_px, budget.tilt_px},
                      plan.blur ? plan.blur->margin_px : 0);
  if (plan.blur) plan.blur->promised_levels = PromisedLevels(scene, plan, promised_levels);
  const bool stands =
      !plan.shake && plan.objects == 0 && !scene.sensor.Noisy() && plan.compression != Compression::kH264;
  plan.render_once =
      scene.still && stands && (!plan.tilt || plan.tilt->frozen) && (!plan.blur || plan.blur->frozen);
  plan.halo_px = plan.WarpMargin() + (plan.blur ? plan.blur->margin_px : 0);
  return plan;
}

}  // namespace shimmer::sim
