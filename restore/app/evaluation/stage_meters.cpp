#include "restore/app/evaluation/stage_meters.h"

#include <algorithm>
#include <cmath>

namespace shimmer::restore::app {
namespace {

constexpr int64_t kMsOfSecond = 1000;

// What had come through a stage when the frame left it.
cv::Mat FrameAfter(const std::string& stage, const FrameOnWay& frame) {
  if (stage == "stabilise") return frame.steady;
  if (stage == "stack") return frame.background;
  return frame.blended.empty() ? frame.frame : frame.blended;
}

}  // namespace

StageMeters::StageMeters(const RestorePlan& plan, std::string variant, bool all_stages, bool as_input)
    : plan_(plan), variant_(std::move(variant)), all_stages_(all_stages), as_input_(as_input) {
  if (!all_stages) return;
  stages_ = {{"stabilise", true}, {"stack", plan.stack}, {"blend", plan.stack && plan.segment}};
}

void StageMeters::Add(const FrameOnWay& frame, const TrueFrame& truth, std::optional<cv::Point2d> true_px,
                      cv::Point2d found_px) {
  // Within bars that never change the stages work on the picture alone.
  const TrueFrame inside = truth.Inside(plan_.picture);
  const cv::Mat moving = frame.mask.empty() ? cv::Mat() : cv::Mat(frame.mask >= 128);
  for (Stage& stage : stages_)
    if (stage.is_planned) stage.meter.Add(FrameAfter(stage.name, frame), inside, moving);
  if (as_input_) steady_.Add(frame.steady, inside, moving);
  masks_.Add(moving, inside);
  result_.Add(frame.frame, truth, moving.size() == truth.seen.size() ? moving : cv::Mat());
  if (true_px) shift_errors_px_.push_back(cv::norm(found_px - *true_px));
}

std::vector<ResultRow> StageMeters::Rows(const StageTimes& times, double look_s, int64_t frames,
                                         Value found_tilt_px) const {
  const auto ms_a_frame = [&](double seconds) { return kMsOfSecond * seconds / static_cast<double>(frames); };
  const auto time_of = [&](const std::string& stage) -> Value {
    const auto time = times.find(stage);
    return time == times.end() ? Value() : ms_a_frame(time->second);
  };
  double all_s = look_s;
  for (const auto& [stage, seconds] : times) all_s += seconds;

  std::vector<ResultRow> rows;
  if (as_input_) {
    rows.push_back({kInputName, kResultStage, {}});
    steady_.AddTo(rows.back().measures);
  }
  ResultRow result{variant_, kResultStage, {}};
  result_.AddTo(result.measures);
  masks_.AddTo(result.measures);
  AddShiftErrors(shift_errors_px_, result.measures);
  result.measures[Measure::kFoundTilt] = found_tilt_px;
  result.measures[Measure::kTime] = ms_a_frame(all_s);
  if (all_stages_) {
    Measures after;  // of the last stage that did something
    for (const char* name : kStageNames) {
      ResultRow row{variant_, name, {}};
      const std::string stage = name;
      const auto meter = std::ranges::find_if(stages_, [&](const Stage& each) { return each.name == stage; });
      if (meter != stages_.end()) {
        if (meter->is_planned) {
          after = {};
          meter->meter.AddTo(after);
        }
        row.measures = after;
      }
      if (stage == "sharpen") result_.AddTo(row.measures);
      if (stage == "stabilise") AddShiftErrors(shift_errors_px_, row.measures);
      if (stage == "segment") masks_.AddTo(row.measures);
      if (stage == "look") row.measures[Measure::kFoundTilt] = found_tilt_px;
      row.measures[Measure::kTime] = stage == "look" ? ms_a_frame(look_s) : time_of(stage);
      rows.push_back(row);
    }
  }
  rows.push_back(result);
  return rows;
}

}  // namespace shimmer::restore::app
