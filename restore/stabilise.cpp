#include "restore/stabilise.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "restore/block_shift.h"
#include "restore/detail_level.h"
#include "restore/mosaic.h"
#include "restore/shift_search.h"
#include "restore/translate.h"

namespace shimmer::restore {
namespace {

constexpr int kLeastSide_px = 16;
constexpr double kFlatContrast = 2e-4;  // of the range: a 20th of an 8-bit step is rounding, not texture
constexpr double kRival = 0.85;         // a peak of so much of the best one's score may be the right one
constexpr int kPeaks = 3;
constexpr int kRounds = 4;
constexpr double kStill_px = 0.01;  // of the level: what the next round would add is not worth it
// What a frame that belongs to the video has, however turbulent, and one that doesn't has not: measured.
constexpr double kLeastClearness = 5, kLeastCorrelation = 0.15;

double RangeOf(const cv::Mat& grey, int depth) {
  if (depth == CV_8U) return 255;
  if (depth == CV_16U) return 65535;
  return cv::norm(grey, cv::NORM_INF);
}

cv::Point Whole(cv::Point2d shift) { return {cvRound(shift.x), cvRound(shift.y)}; }

// A frame's detail at its place on the mosaic: the fraction of the shift by resampling, the rest by `at`.
struct Placed {
  cv::Mat detail;
  cv::Point at;

  Placed(const cv::Mat& level, cv::Point2d shift_px, int margin_px)
      : detail(Translated(level, shift_px - cv::Point2d(Whole(shift_px)))),
        at(cv::Point(margin_px, margin_px) - Whole(shift_px)) {}
  cv::Rect area() const { return {at, detail.size()}; }
};

bool Within(cv::Rect area, const cv::Mat& canvas) { return (area & cv::Rect({0, 0}, canvas.size())) == area; }

}  // namespace

struct Stabiliser::Levels {
  cv::Size size;
  int type;
  LevelScales scales;
  std::optional<Mosaic> fine, coarse;  // once a frame showed something

  double ratio() const { return static_cast<double>(scales.coarse) / scales.fine; }

  void Add(const cv::Mat& fine_detail, const cv::Mat& coarse_detail, cv::Point2d fine_px) {
    const Placed on_fine(fine_detail, fine_px, fine->margin_px()),
        on_coarse(coarse_detail, fine_px / ratio(), coarse->margin_px());
    fine->Add(on_fine.detail, on_fine.at);
    coarse->Add(on_coarse.detail, on_coarse.at);
  }

  struct Refined {
    cv::Point2d fine_px;
    double correlation;
    CommonShift common;
  };

  // From a shift that is good to a px of the fine level or two; none if it leads off the canvas.
  std::optional<Refined> Refine(const cv::Mat& detail, cv::Point2d fine_px) const {
    Refined refined{fine_px, 0, {}};
    for (int round = 0; round < kRounds; ++round) {
      const Placed placed(detail, refined.fine_px, fine->margin_px());
      if (!Within(placed.area(), fine->mean())) return {};
      const cv::Mat mean = fine->mean()(placed.area()), frames = fine->frames()(placed.area());
      const cv::Mat seen = frames > 0;
      const double product = placed.detail.dot(mean);
      const double energies = cv::norm(placed.detail, cv::NORM_L2SQR, seen) * cv::norm(mean, cv::NORM_L2SQR);
      refined.correlation = energies > 0 ? product / std::sqrt(energies) : 0;
      refined.common = CommonShiftOf(BlockShifts(placed.detail, mean, frames));
      const cv::Point2d step = refined.common.shift_px;
      if (!std::isfinite(step.x) || !std::isfinite(step.y)) return {};
      refined.fine_px += step;
      if (cv::norm(step) < kStill_px) break;
    }
    if (!Within(Placed(detail, refined.fine_px, fine->margin_px()).area(), fine->mean())) return {};
    return refined;
  }
};

Stabiliser::Stabiliser(StabiliseParams params) : params_(params) {
  if (!std::isfinite(params.max_shift_px) || params.max_shift_px < 0)
    throw std::invalid_argument("max_shift_px = " + std::to_string(params.max_shift_px) +
                                ", must be 0 or more");
}
Stabiliser::~Stabiliser() = default;
Stabiliser::Stabiliser(Stabiliser&&) noexcept = default;
Stabiliser& Stabiliser::operator=(Stabiliser&&) noexcept = default;

FrameShift Stabiliser::Next(const cv::Mat& frame) {
  const int side = std::min(frame.cols, frame.rows);
  if (side < kLeastSide_px)
    throw std::invalid_argument("frame is " + std::to_string(frame.cols) + "x" + std::to_string(frame.rows) +
                                " px, must be at least 16x16");
  if (!levels_)
    levels_ =
        std::make_unique<Levels>(Levels{frame.size(), frame.type(), LevelScalesOf(frame.size()), {}, {}});
  if (frame.size() != levels_->size || frame.type() != levels_->type)
    throw std::invalid_argument("a frame of another size or type than the first");
  const LevelScales scales = levels_->scales;
  const cv::Mat grey = ReducedGrey(frame, scales.fine);
  const Detail fine = DetailOf(grey);
  if (fine.contrast <= kFlatContrast * RangeOf(grey, frame.depth()))
    return {.px = last_px_, .match = Match::kFlat};
  const Detail coarse =
      scales.coarse == scales.fine ? fine : DetailOf(ReducedGrey(grey, scales.coarse / scales.fine));
  if (!levels_->fine) {
    const double most_px = std::min(params_.max_shift_px > 0 ? params_.max_shift_px : side * 400.0 / 1080,
                                    static_cast<double>(std::max(frame.cols, frame.rows)));
    // (the mean of the turbulence comes on top)
    const int margin = static_cast<int>(std::ceil(most_px / scales.coarse)) + 1;
    levels_->coarse.emplace(coarse.values.size(), margin);
    levels_->fine.emplace(fine.values.size(), margin * scales.coarse / scales.fine + 2);
    levels_->Add(fine.values, coarse.values, {});
    return {.px = {}, .match = Match::kFound, .correlation = 1};
  }
  const std::vector<ShiftPeak> peaks = BestShifts(coarse.values, *levels_->coarse, kPeaks);
  std::optional<Levels::Refined> best;
  double clearness = 0;
  for (const ShiftPeak& peak : peaks) {
    if (peak.clearness < kRival * peaks.front().clearness) break;
    const auto refined = levels_->Refine(fine.values, peak.shift_px * levels_->ratio());
    if (refined && (!best || refined->correlation > best->correlation))
      best = refined, clearness = peak.clearness;
  }
  FrameShift shift{.px = last_px_, .match = Match::kLost, .clearness = clearness};
  if (!best) return shift;
  shift.correlation = best->correlation;
  shift.scatter_px = best->common.scatter_px * scales.fine;
  shift.error_px = best->common.error_px * scales.fine;
  if (clearness < kLeastClearness || best->correlation < kLeastCorrelation) return shift;
  levels_->Add(fine.values, coarse.values, best->fine_px);
  shift.match = Match::kFound;
  shift.px = last_px_ = best->fine_px * scales.fine;
  return shift;
}

bool IsSteady(std::span<const FrameShift> shifts) {
  return std::all_of(shifts.begin(), shifts.end(), [](const FrameShift& shift) {
    return std::abs(shift.px.x) < 0.5 && std::abs(shift.px.y) < 0.5;
  });
}

cv::Rect CommonArea(std::span<const FrameShift> shifts, cv::Size size) {
  cv::Rect area({0, 0}, size);
  for (const FrameShift& shift : shifts) area &= SeenArea(size, shift.px);
  return area;
}

}  // namespace shimmer::restore
