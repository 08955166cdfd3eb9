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

}  // namespace

RestorePlan PlanRestore(const VideoFacts& facts, const RestoreParams& params) {
  RestorePlan plan{.size = facts.size,
                   .frames = facts.frames,
                   .grey = facts.grey,
                   .alike = facts.alike,
                   .area = cv::Rect({}, facts.size)};
  const auto skip = [&](const std::string& line) { plan.skipped.push_back(line); };
  if (plan.grey && CV_MAT_CN(facts.type) == 3) skip("two of three channels: they are equal everywhere");
  if (plan.alike) {
    skip(facts.frames == 1 ? "everything: there is one frame, and nothing to compare it with"
                           : "everything: all frames are the same");
    return plan;
  }
  if (!params.stabilise)
    skip("stabilising: it is switched off");
  else if (IsSteady(facts.shifts))
    skip("stabilising: the camera stands (it is off its place by up to " + Px(MostShift_px(facts)) + ")");
  else
    plan.stabilise = true;
  if (!plan.stabilise) return plan;
  plan.fill = params.border == Border::kFill;
  if (plan.fill) return plan;
  plan.area = CommonArea(facts.shifts, facts.size);
  if (plan.area.empty())
    throw std::invalid_argument("border = crop leaves nothing: no px is on all frames, shifts reach " +
                                Px(MostShift_px(facts)) + ". Must be fill, or a shorter part of the video");
  return plan;
}

}  // namespace shimmer::restore
