// The frames of a pipeline measured at each of its stages.
#pragma once

#include <string>
#include <vector>

#include "restore/app/evaluation/results.h"
#include "restore/app/evaluation/sequence_meter.h"
#include "restore/pipeline.h"
#include "restore/plan.h"

namespace shimmer::restore::app {

class StageMeters {
 public:
  // all_stages: else the result alone. as_input: that also what stabilising gives is measured for the input's
  // row, which a real video has no truth for.
  StageMeters(const RestorePlan& plan, std::string variant, bool all_stages, bool as_input);

  // found_px: by which the frame was steadied.
  void Add(const FrameOnWay& frame, const TrueFrame& truth, std::optional<cv::Point2d> true_px,
           cv::Point2d found_px);

  // look_s: what looking took; times: what the stages took. found_tilt_px: as in Measure.
  std::vector<ResultRow> Rows(const StageTimes& times, double look_s, int64_t frames,
                              Value found_tilt_px) const;

 private:
  struct Stage {
    const char* name;
    bool is_planned;
    SequenceMeter meter = {};
  };

  RestorePlan plan_;
  std::string variant_;
  bool all_stages_, as_input_;
  std::vector<Stage> stages_;  // that make frames
  SequenceMeter steady_, result_;
  MaskMeter masks_;
  std::vector<double> shift_errors_px_;
};

}  // namespace shimmer::restore::app
