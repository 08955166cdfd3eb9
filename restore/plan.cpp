#include "restore/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace shimmer::restore {
namespace {

std::string Px(double px) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f px", px);
  return text;
}

// The most that the camera is off its first place along an axis.
double MostShift_px(const VideoFacts& facts) {
  double most_px = 0;
  for (const FrameShift& shift : facts.shifts)
    most_px = std::max({most_px, std::abs(shift.px.x), std::abs(shift.px.y)});
  return most_px;
}

void PlanSteadying(const VideoFacts& facts, const RestoreParams& params, RestorePlan& plan) {
  if (!params.stabilise || IsSteady(facts.shifts)) {
    plan.skipped.push_back(params.stabilise
                               ? "stabilising: the camera stands (it is off its place by up to " +
                                     Px(MostShift_px(facts)) + ")"
                               : "stabilising: it is switched off");
    return;
  }
  plan.stabilise = true;
  plan.fill = params.border == Border::kFill;
  if (plan.fill) return;
  plan.area = CommonArea(facts.shifts, facts.size);
  if (!plan.area.empty()) plan.area += plan.picture.tl();
  if (plan.area.empty())
    throw std::invalid_argument("border = crop leaves nothing: no px is on all frames, shifts reach " +
                                Px(MostShift_px(facts)) + ". Must be fill, or a shorter part of the video");
}

void PlanPicture(const VideoFacts& facts, RestorePlan& plan) {
  const Changing& changing = facts.changing;
  const bool bars = !changing.first.empty();
  plan.size = bars ? changing.first.size() : facts.size;
  plan.picture = bars ? changing.area : cv::Rect({}, facts.size);
  plan.area = cv::Rect({}, plan.size);
  if (!bars) return;
  char line[160];
  std::snprintf(line, sizeof line,
                "bars around the picture: they never change, %.2f %% of the frame; %dx%d px from (%d, %d) do",
                100 - 100.0 * plan.picture.area() / plan.size.area(), plan.picture.width, plan.picture.height,
                plan.picture.x, plan.picture.y);
  plan.skipped.emplace_back(line);
}

// Below it the tilt is less than what the averaging of frames itself makes softer.
constexpr double kLeastTilt_px = 0.05;

void PlanScene(const VideoFacts& facts, const RestoreParams& params, RestorePlan& plan) {
  if (!params.stack || !facts.scene) {
    plan.skipped.push_back("segmenting, stacking and blending: they are switched off");
    return;
  }
  const double tilt_px = std::sqrt(facts.scene->strength.tilt_variance_px2);
  if (tilt_px < kLeastTilt_px) {
    plan.skipped.push_back(
        "segmenting, stacking and blending: the turbulence is too weak to need them (a tilt of " +
        Px(tilt_px) + ")");
    return;
  }
  const BackgroundParams background = BackgroundFor(facts.scene->strength, params.registered);
  plan.stack = true;
  plan.ahead = background.ahead;
  plan.registered = background.registered;
  plan.segment = params.segment && facts.scene->moving_share > 0;
  if (!plan.segment)
    plan.skipped.push_back(std::string("segmenting and blending: ") +
                           (params.segment ? "nothing moves" : "they are switched off"));
}

}  // namespace

RestorePlan PlanRestore(const VideoFacts& facts, const RestoreParams& params) {
  RestorePlan plan{.size = {},
                   .frames = facts.frames,
                   .grey = facts.grey,
                   .alike = facts.alike,
                   .picture = {},
                   .area = {}};
  PlanPicture(facts, plan);
  const auto skip = [&](const std::string& line) { plan.skipped.push_back(line); };
  if (plan.grey && CV_MAT_CN(facts.type) == 3) skip("two of three channels: they are equal everywhere");
  if (plan.alike) {
    skip(facts.frames == 1 ? "everything: there is one frame, and nothing to compare it with"
                           : "everything: all frames are the same");
    return plan;
  }
  PlanSteadying(facts, params, plan);
  PlanScene(facts, params, plan);
  return plan;
}

}  // namespace shimmer::restore
