#include "restore/app/plan_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/number_text.h"
#include "restore/tiles.h"

namespace shimmer::restore::app {
namespace {

using Json = nlohmann::ordered_json;

std::string Decimals(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

std::string KindText(int type) {
  const std::string depth = CV_MAT_DEPTH(type) == CV_8U    ? "8 bits"
                            : CV_MAT_DEPTH(type) == CV_16U ? "16 bits"
                                                           : "floats";
  return (CV_MAT_CN(type) == 1 ? "grey, " : "RGB, ") + depth;
}

// Of the frames that were found: how far the camera goes, and how much the air moves their parts.
std::string ShakeText(const VideoFacts& facts) {
  double most_px = 0;
  std::vector<double> scatter_px;
  int64_t flat = 0, lost = 0, unsure = 0;
  for (const FrameShift& shift : facts.shifts) {
    most_px = std::max({most_px, std::abs(shift.px.x), std::abs(shift.px.y)});
    flat += shift.match == Match::kFlat;
    lost += shift.match == Match::kLost;
    unsure += shift.unsure;
    if (shift.match == Match::kFound) scatter_px.push_back(shift.scatter_px);
  }
  std::string text = "shake     up to " + Decimals(most_px) + " px\n";
  if (!scatter_px.empty()) {
    std::ranges::nth_element(scatter_px, scatter_px.begin() + std::ssize(scatter_px) / 2);
    text += "scatter   about " + Decimals(scatter_px[scatter_px.size() / 2]) + " px, of blocks of a frame\n";
  }
  if (flat > 0)
    text += cli::Counted(flat, "frame") +
            " with too little detail to be placed: they stay where the one before is\n";
  if (lost > 0)
    text += cli::Counted(lost, "frame") + " unlike the others: they stay where the one before is\n";
  if (unsure > 0)
    text +=
        cli::Counted(unsure, "frame") + " in which much moves otherwise: the shake may be a large object's\n";
  return text;
}

// A steadied video has lost what is common to a whole frame, of the air too.
std::string Cn2Text(const VideoFacts& facts, const RestorePlan& plan, const std::optional<Optics>& optics) {
  const std::string name = "Cn2       ";
  if (!facts.scene) {
    if (!optics) return "";
    return name + "not found: " + (facts.alike ? "nothing changes" : "there is no still scene") + "\n";
  }
  const TurbulenceStrength& strength = facts.scene->strength;
  if (strength.texture == 0) return name + "not found: there is no texture to tell it by\n";
  const std::string at_least = plan.stabilise ? "at least " : "";
  char number[64];
  if (optics) {
    std::snprintf(number, sizeof number, "%.3g m^(-2/3)\n", Cn2Of(strength.tilt_variance_px2, *optics));
    return name + at_least + number;
  }
  std::snprintf(number, sizeof number, "%.3g px^2", strength.tilt_variance_px2);
  return name + "proportional to " + at_least + number + ", the tilt's variance (no optics are given)\n";
}

// How strong the air is, and how much moves.
std::string SceneText(const SceneFacts& scene) {
  std::string text = "tilt      " + Decimals(std::sqrt(scene.strength.tilt_variance_px2)) +
                     " px along an axis, in " + Decimals(100 * scene.strength.texture) +
                     " % of the picture\n";
  return text + "moving    " + Decimals(100 * scene.moving_share) + " % of the picture\n";
}

}  // namespace

std::string PlanText(const VideoFacts& facts, const RestorePlan& plan, const std::optional<Optics>& optics) {
  std::string text = "frames    " + cli::Grouped(facts.frames) + " of " + std::to_string(plan.size.width) +
                     "x" + std::to_string(plan.size.height) + " px, " + KindText(facts.type) + "\n" +
                     ShakeText(facts);
  std::string stages;
  if (plan.stabilise) stages += plan.fill ? ", stabilise and fill" : ", stabilise and crop";
  if (plan.segment) stages += ", segment";
  if (plan.stack)
    stages += ", stack " + cli::Counted(2 * plan.ahead + 1, "frame") +
              (plan.registered ? " registered" : "") + (plan.lucky ? " by luck" : "") +
              (plan.segment ? ", blend" : "");
  if (plan.sharpen) stages += ", sharpen";
  if (facts.scene) text += SceneText(*facts.scene);
  text += Cn2Text(facts, plan, optics);
  text += "stages    " + (stages.empty() ? "none" : stages.substr(2)) + "\n";
  if (plan.sharpen)
    text +=
        "sharpen   in " +
        cli::Counted(std::ssize(Tiles(SharpenedSize(plan), plan.sharpen->side_px, plan.sharpen->overlap_px)),
                     "tile") +
        ", of which those are left out that are flat or hardly change\n";
  if (plan.area.size() != plan.size)
    text += "area      " + std::to_string(plan.area.width) + "x" + std::to_string(plan.area.height) +
            " px from (" + std::to_string(plan.area.x) + ", " + std::to_string(plan.area.y) + ")\n";
  if (!plan.skipped.empty()) text += "skipped\n";
  for (const std::string& line : plan.skipped) text += "  " + line + "\n";
  return text;
}

Json PlanJson(const VideoFacts& facts, const RestorePlan& plan, const SharpenCounts& counts) {
  Json shifts = Json::array(), matches = Json::array();
  for (const FrameShift& shift : facts.shifts) {
    shifts.push_back({shift.px.x, shift.px.y});
    matches.push_back(shift.match == Match::kFound ? "found" : shift.match == Match::kFlat ? "flat" : "lost");
  }
  return {{"size", {plan.size.width, plan.size.height}},
          {"frames", plan.frames},
          {"grey", plan.grey},
          {"stabilise", plan.stabilise},
          {"fill", plan.fill},
          {"picture", {plan.picture.x, plan.picture.y, plan.picture.width, plan.picture.height}},
          {"area", {plan.area.x, plan.area.y, plan.area.width, plan.area.height}},
          {"segment", plan.segment},
          {"stack", plan.stack},
          {"ahead", plan.ahead},
          {"registered", plan.registered},
          {"lucky", plan.lucky},
          {"luck_octaves", facts.scene ? Json(facts.scene->luck_octaves) : Json()},
          {"tilt_variance_px2", facts.scene ? Json(facts.scene->strength.tilt_variance_px2) : Json()},
          {"moving_share", facts.scene ? Json(facts.scene->moving_share) : Json()},
          {"sharpen", plan.sharpen ? Json{{"tile_px", plan.sharpen->side_px},
                                          {"overlap_px", plan.sharpen->overlap_px},
                                          {"tiles_computed", counts.computed},
                                          {"tiles_kept", counts.kept},
                                          {"tiles_flat", counts.flat}}
                                   : Json()},
          {"skipped", plan.skipped},
          {"shifts_px", std::move(shifts)},
          {"matches", std::move(matches)}};
}

}  // namespace shimmer::restore::app
