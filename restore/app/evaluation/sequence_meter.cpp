#include "restore/app/evaluation/sequence_meter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "restore/line_deviation.h"
#include "restore/mask_scores.h"
#include "restore/psnr.h"
#include "restore/regions.h"
#include "restore/rolling.h"
#include "restore/ssim.h"
#include "restore/stability.h"

namespace shimmer::restore::app {
namespace {

// All, background, foreground and its box; the last three are empty where the truth does not say what moves.
std::vector<cv::Mat> RegionsOf(const TrueFrame& truth) {
  if (!truth.moving) return {truth.seen, {}, {}, {}};
  const cv::Mat foreground = *truth.moving & truth.seen;
  return {truth.seen, truth.seen & ~foreground, foreground, BoxAround(foreground) & truth.seen};
}

}  // namespace

void SequenceMeter::Add(const cv::Mat& frame, const TrueFrame& truth, const cv::Mat& found) {
  if (truth.clean) {
    std::vector<cv::Mat> regions = RegionsOf(truth);
    std::erase_if(regions, [](const cv::Mat& region) { return region.empty(); });
    const std::vector<Value> psnr = PsnrIn(frame, *truth.clean, regions),
                             ssim = SsimIn(frame, *truth.clean, regions);
    for (size_t i = 0; i < regions.size(); ++i) {
      scores_[2 * i].push_back(psnr[i]);
      scores_[2 * i + 1].push_back(ssim[i]);
    }
  }
  line_deviation_deg_.push_back(LineDeviation_deg(frame));
  cv::Mat unsteady = ~truth.seen;
  if (truth.moving)
    unsteady |= *truth.moving;
  else if (!found.empty())
    unsteady |= found;
  if (!before_.empty())
    difference_levels_.push_back(FrameDifference(before_, frame, unsteady | unsteady_before_));
  before_ = frame.clone();
  unsteady_before_ = unsteady;
}

void SequenceMeter::AddTo(Measures& measures) const {
  for (size_t i = 0; i < scores_.size(); ++i)
    measures[static_cast<Measure>(static_cast<size_t>(Measure::kPsnr) + i)] = MeanOfPresent(scores_[i]);
  measures[Measure::kLineDeviation] = MeanOfPresent(line_deviation_deg_);
  measures[Measure::kStability] = MeanOfPresent(difference_levels_);
}

void MaskMeter::Add(const cv::Mat& found, const TrueFrame& truth) {
  if (!truth.moving) return;
  cv::Mat found_seen = cv::Mat::zeros(truth.seen.size(), CV_8UC1);
  if (!found.empty()) found_seen = found & truth.seen;
  const MaskCounts counts = CompareMasks(found_seen, *truth.moving & truth.seen);
  iou_.push_back(counts.Iou());
  precision_.push_back(counts.Precision());
  recall_.push_back(counts.Recall());
}

void MaskMeter::AddTo(Measures& measures) const {
  measures[Measure::kIou] = MeanOfPresent(iou_);
  measures[Measure::kPrecision] = MeanOfPresent(precision_);
  measures[Measure::kRecall] = MeanOfPresent(recall_);
}

void AddShiftErrors(std::vector<double> errors_px, Measures& measures) {
  if (errors_px.empty()) return;
  std::ranges::sort(errors_px);
  const size_t count = errors_px.size();
  // The smallest that 95 % of the frames are within.
  const auto p95 = static_cast<size_t>(std::ceil(0.95 * static_cast<double>(count))) - 1;
  measures[Measure::kShiftMean] =
      std::accumulate(errors_px.begin(), errors_px.end(), 0.0) / static_cast<double>(count);
  measures[Measure::kShiftP95] = errors_px[p95];
  measures[Measure::kShiftMost] = errors_px.back();
}

}  // namespace shimmer::restore::app
