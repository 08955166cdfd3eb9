#include "restore/stabilise.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "restore/alignment.h"
#include "restore/detail_level.h"
#include "restore/translate.h"

namespace shimmer::restore {
namespace {

constexpr int kLeastSide_px = 16;
// Of the range: a 20th of an 8-bit step is rounding and no texture; below half a step it fades.
constexpr double kFlatContrast = 2e-4, kLeastContrast = 2e-3;
// Frames of other scenes correlate by up to 0.15 at the best of all shifts (0.6 where a frame is tiny);
// frames of the same scene by 0.4 and more under strong turbulence. Noise lowers the correlation, but not
// below chance.
constexpr double kLeastCorrelation = 0.12, kLeastEvidence = 1.8;  // evidence: correlation * clearness

// Of the texture. Frames that follow nothing had 0.75 and more; of two clips that follow a car one had 0.4 to
// 0.71, the other less than this in 8 of 27 frames only.
constexpr double kLeastAgreeing = 0.72;

constexpr int kLeastScene = 8;  // frames

// A frame of a scene that has next to no detail may match nothing, and be the same scene all the same: its
// means of 16x16 parts tell. Those of other scenes correlate by 0.8 at most where one has a bright sky as
// well.
constexpr int kParts = 16;
constexpr double kSameParts = 0.97;

// The means of a frame's parts, without their mean, of length 1 (or 0).
cv::Mat PartsOf(const cv::Mat& grey) {
  cv::Mat parts;
  cv::resize(grey, parts, {kParts, kParts}, 0, 0, cv::INTER_AREA);
  parts.convertTo(parts, CV_64F);
  parts -= cv::mean(parts);
  return parts / std::max(cv::norm(parts), 1e-30);
}

double RangeOf(const cv::Mat& grey, int depth) {
  if (depth == CV_8U) return 255;
  if (depth == CV_16U) return 65535;
  return std::max(cv::norm(grey, cv::NORM_INF), 1e-30);
}

}  // namespace

struct Stabiliser::State {
  cv::Size size;
  int type;
  LevelScales scales;
  std::optional<Alignment> alignment = {};  // once a frame showed something
  bool settled = false;                     // the first frames' shifts are given out
  std::vector<FrameShift> held = {};        // until then
  std::vector<FrameDetail> details = {};    // of those of them that were found
  std::vector<Fit> fits = {};
  cv::Point2d last_px = {};
  cv::Mat last_parts = {};    // of the last frame that was found
  double first_error_px = 0;  // of the first frame found, against the others; fine px, 0 as long as unknown

  FrameShift ShiftOf(const Fit& fit, Match match) const {
    return {match == Match::kFound ? fit.fine_px * scales.fine : last_px,
            match,
            fit.correlation,
            fit.clearness,
            fit.common.scatter_px * scales.fine,
            ErrorOf(fit) * scales.fine,
            fit.common.agreeing,
            match == Match::kFound && fit.common.agreeing < kLeastAgreeing};
  }

  // s is from the first frame to this one, and both have their own air. (As long as the first one's is
  // unknown, it is taken to be as strong.)
  double ErrorOf(const Fit& fit) const {
    const double own_px = fit.common.error_px;
    return std::hypot(own_px, first_error_px > 0 ? first_error_px : own_px);
  }

  void Use(const FrameDetail& detail, const Fit& fit) {
    alignment->Add(detail, fit.fine_px);
    if (settled) return;
    details.push_back(detail);
    fits.push_back(fit);
  }

  FrameShift Fitted(const cv::Mat& frame, double max_shift_px);
  void Settle();
};

FrameShift Stabiliser::State::Fitted(const cv::Mat& frame, double max_shift_px) {
  const cv::Mat grey = ReducedGrey(frame, scales.fine);
  const double range = RangeOf(grey, frame.depth());
  const Detail fine = DetailOf(grey, kLeastContrast * range);
  if (fine.contrast <= kFlatContrast * range) return {.px = last_px, .match = Match::kFlat};
  const int ratio = scales.coarse / scales.fine;
  const FrameDetail detail{
      fine.values,
      ratio == 1 ? fine.values : DetailOf(ReducedGrey(grey, ratio), kLeastContrast * range).values};
  if (!alignment) {
    // (the mean of the turbulence comes on top, and a peak needs neighbours)
    const int margin = static_cast<int>(std::ceil(max_shift_px / scales.coarse)) + 2;
    alignment.emplace(detail.fine.size(), detail.coarse.size(), ratio, margin);
    last_parts = PartsOf(grey);
    const Fit first{.fine_px = {}, .correlation = 1, .common = {.shift_px = {}, .agreeing = 1}};
    Use(detail, first);
    return ShiftOf(first, Match::kFound);
  }
  const std::optional<Fit> fit = alignment->Search(detail);
  const cv::Mat parts = PartsOf(grey);
  if (!fit || fit->correlation < kLeastCorrelation || fit->correlation * fit->clearness < kLeastEvidence) {
    const Match match = parts.dot(last_parts) >= kSameParts ? Match::kFlat : Match::kLost;
    return fit ? ShiftOf(*fit, match) : FrameShift{.px = last_px, .match = match};
  }
  last_parts = parts;
  Use(detail, *fit);
  return ShiftOf(*fit, Match::kFound);
}

void Stabiliser::State::Settle() {
  settled = true;
  if (fits.empty()) return;  // nothing was to be seen
  AlignTogether(details, fits, *alignment);
  first_error_px = fits.front().common.error_px;
  last_px = {};
  size_t found = 0;
  for (FrameShift& shift : held) {
    if (shift.match == Match::kFound)
      shift = ShiftOf(fits[found++], Match::kFound);
    else
      shift.px = last_px;
    if (shift.match == Match::kFound && found == 1) shift.error_px = 0;  // s is (0, 0) there by definition
    last_px = shift.px;
  }
  details.clear();
  fits.clear();
}

Stabiliser::Stabiliser(StabiliseParams params) : params_(params) {
  if (!std::isfinite(params.max_shift_px) || params.max_shift_px < 0)
    throw std::invalid_argument("max_shift_px = " + std::to_string(params.max_shift_px) +
                                ", must be 0 or more");
  if (params.first_frames < 1)
    throw std::invalid_argument("first_frames = " + std::to_string(params.first_frames) +
                                ", must be 1 or more");
}
Stabiliser::~Stabiliser() = default;
Stabiliser::Stabiliser(Stabiliser&&) noexcept = default;
Stabiliser& Stabiliser::operator=(Stabiliser&&) noexcept = default;

std::vector<FrameShift> Stabiliser::Next(const cv::Mat& frame) {
  const int side = std::min(frame.cols, frame.rows);
  if (side < kLeastSide_px)
    throw std::invalid_argument("frame is " + std::to_string(frame.cols) + "x" + std::to_string(frame.rows) +
                                " px, must be at least 16x16");
  if (!state_)
    state_ = std::make_unique<State>(State{frame.size(), frame.type(), LevelScalesOf(frame.size())});
  if (frame.size() != state_->size || frame.type() != state_->type)
    throw std::invalid_argument("frame is of another size or type than the first");
  const double most_px = params_.max_shift_px > 0 ? params_.max_shift_px : side * 400.0 / 1080;
  const FrameShift shift =
      state_->Fitted(frame, std::min(most_px, static_cast<double>(std::max(frame.cols, frame.rows))));
  state_->last_px = shift.px;
  if (state_->settled) return {shift};
  state_->held.push_back(shift);
  return static_cast<int>(state_->held.size()) < params_.first_frames ? std::vector<FrameShift>{} : Rest();
}

std::vector<FrameShift> Stabiliser::Rest() {
  if (!state_ || state_->settled) return {};
  state_->Settle();
  return std::exchange(state_->held, {});
}

bool IsSteady(std::span<const FrameShift> shifts) {
  return std::all_of(shifts.begin(), shifts.end(), [](const FrameShift& shift) {
    return std::abs(shift.px.x) < 0.5 && std::abs(shift.px.y) < 0.5;
  });
}

bool AreOfOneScene(std::span<const FrameShift> shifts) {
  const auto count = [&](Match match) { return std::ranges::count(shifts, match, &FrameShift::match); };
  return count(Match::kFound) >= count(Match::kLost);
}

std::optional<size_t> LastingCut(std::span<const FrameShift> shifts) {
  size_t cut = shifts.size();  // the first frame after the last that was found
  while (cut > 0 && shifts[cut - 1].match != Match::kFound) --cut;
  const auto count = [](std::span<const FrameShift> of, Match match) {
    return std::ranges::count(of, match, &FrameShift::match);
  };
  if (count(shifts.first(cut), Match::kFound) < kLeastScene ||
      count(shifts.subspan(cut), Match::kLost) < kLeastScene)
    return {};
  while (shifts[cut].match != Match::kLost) ++cut;  // (past the black between two scenes)
  return cut;
}

cv::Rect CommonArea(std::span<const FrameShift> shifts, cv::Size size) {
  cv::Rect area({0, 0}, size);
  for (const FrameShift& shift : shifts) area &= SeenArea(size, shift.px);
  return area;
}

}  // namespace shimmer::restore
