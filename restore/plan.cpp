#include "restore/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "restore/flow.h"
#include "restore/luck.h"

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

void RequireNoCut(const VideoFacts& facts) {
  const std::optional<size_t> cut = LastingCut(facts.shifts);
  if (!cut) return;
  const std::string at = std::to_string(*cut);
  throw std::invalid_argument("frames " + at + " to " + std::to_string(facts.frames - 1) +
                              " show another scene than those before, or the camera went too far: must be "
                              "one scene. Split the video before frame " +
                              at + ", or take it as it is without stabilising (--no-stabilise)");
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
// And below it next to no blur of the air's is left after averaging, and the network takes a scene's own
// softness for it: of 80 clips other than those it was set on, 31 of the 34 with a tilt below 0.5 px lost, up
// to 3.3 dB; from 0.6 px on 44 of 46 gained, and none lost more than 0.1 dB.
constexpr double kLeastSharpenedTilt_px = 0.6;
constexpr double kMostMoving = 0.5, kLeastMoving = 0.002;  // shares of the picture
// Air whose tilt is v along each axis moves a px by 1.77 v between two frames, on average. And
// StrengthEstimate finds no more than 3.1 px in clips of Shimmer's of 4.9 px.
constexpr double kMostOfTilt = 2, kLeastMotion_px = 2.5, kMostTilt_px = 6;
// A camera that goes along moves its picture on, by so much a frame and more, as most of what moves there
// does: 0.9 px and 0.7 of it where skiers are followed, at most 0.2 px and 0.5 in ten videos of real air.
constexpr double kLeastPace_px = 0.4, kLeastSteady = 0.6;

double TiltOf(const SceneFacts& scene) { return std::sqrt(scene.strength.tilt_variance_px2); }

// How most of the picture moves, other than by turbulence; nothing where it does not.
std::string MotionEverywhere(const SceneFacts& scene, cv::Size size) {
  if (scene.segment.method == SegmentMethod::kFused && scene.moving_share > kMostMoving)
    return "more than half of the picture moves";
  const double scale = std::max(size.width, size.height) > kLargeSide_px ? 2 : 1;
  const double motion_px = scale * scene.segment.aof.typical_px, tilt_px = TiltOf(scene);
  const double pace_px = scale * scene.segment.typical_speed_px;
  const bool goes_along = pace_px > kLeastPace_px &&
                          pace_px * MeanDistance(scene.segment.aof.neighbours) > kLeastSteady * motion_px;
  const bool moves_on = goes_along || motion_px > std::max(kLeastMotion_px, kMostOfTilt * tilt_px);
  if (!moves_on && tilt_px <= kMostTilt_px) return {};
  return "most of the picture moves on by more than turbulence does (" + Px(std::max(motion_px, tilt_px)) +
         ")";
}

void PlanScene(const VideoFacts& facts, const RestoreParams& params, RestorePlan& plan) {
  if (!params.stack || !facts.scene) {
    plan.skipped.push_back("segmenting, stacking and blending: they are switched off");
    return;
  }
  const std::string all = "segmenting, stacking and blending: ";
  if (const std::string motion = MotionEverywhere(*facts.scene, facts.size); !motion.empty()) {
    plan.skipped.push_back(all + motion + ": there is no still scene");
    return;
  }
  if (facts.scene->strength.texture == 0) {
    plan.skipped.push_back(all + "no still scene with texture is found to tell the turbulence by");
    return;
  }
  const double tilt_px = TiltOf(*facts.scene);
  if (tilt_px < kLeastTilt_px) {
    plan.skipped.push_back(all + "the turbulence is too weak to need them (a tilt of " + Px(tilt_px) + ")");
    return;
  }
  const BackgroundParams background = BackgroundFor(facts.scene->strength, params.registered);
  plan.stack = true;
  plan.ahead = background.ahead;
  plan.registered = background.registered;
  plan.lucky = facts.frames >= kLeastLuckyFrames && facts.scene->luck_octaves >= kLeastLuck_octaves;
  plan.segment = params.segment && facts.scene->moving_share > 0;
  if (!plan.segment)
    plan.skipped.push_back(std::string("segmenting and blending: ") +
                           (params.segment ? "nothing moves" : "they are switched off"));
}

// Why a network would only do harm: it has seen nothing but what the air blurs, and would take a scene's own
// softness for the air's. Empty: it would not.
std::string NeedlessSharpening(const VideoFacts& facts) {
  if (!facts.scene) return {};
  const SceneFacts& scene = *facts.scene;
  if (scene.strength.texture == 0)
    return scene.moving_share < kLeastMoving ? "there is no texture that the air could blur" : "";
  return TiltOf(scene) < kLeastSharpenedTilt_px ? "the turbulence is too weak to need it" : "";
}

// Last, as the area is known by then.
void PlanSharpening(const VideoFacts& facts, const RestoreParams& params, RestorePlan& plan) {
  const std::string why = params.sharpen ? NeedlessSharpening(facts) : "it is switched off";
  if (!why.empty()) {
    plan.skipped.push_back("sharpening: " + why);
    return;
  }
  RequireTile(*params.sharpen, SharpenedSize(plan));
  plan.sharpen = params.sharpen;
}

// What is not done to a video that has no scene to stack.
std::string AllStages(const RestoreParams& params) {
  return params.sharpen ? "everything but sharpening: " : "everything: ";
}

}  // namespace

cv::Size SharpenedSize(const RestorePlan& plan) {
  return plan.area.size() != plan.size ? plan.area.size() : plan.picture.size();
}

bool HasOneScene(const VideoFacts& facts, const RestoreParams& params) {
  return !facts.alike && (!params.stabilise || (AreOfOneScene(facts.shifts) && !LastingCut(facts.shifts)));
}

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
    if (facts.frames > 1) {
      skip("everything: all frames are the same");
      return plan;
    }
    skip(AllStages(params) + "there is one frame, and nothing to compare it with");
    PlanSharpening(facts, params, plan);
    return plan;
  }
  if (params.stabilise) RequireNoCut(facts);
  if (!HasOneScene(facts, params)) {
    const auto lost = std::ranges::count(facts.shifts, Match::kLost, &FrameShift::match);
    skip(AllStages(params) + std::to_string(lost) +
         " frames show something else than those before, as the "
         "camera goes too far, or everything moves");
    PlanSharpening(facts, params, plan);
    return plan;
  }
  PlanSteadying(facts, params, plan);
  PlanScene(facts, params, plan);
  PlanSharpening(facts, params, plan);
  return plan;
}

}  // namespace shimmer::restore
