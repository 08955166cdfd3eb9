#include "restore/alignment.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "restore/shift_search.h"
#include "restore/translate.h"

namespace shimmer::restore {
namespace {

constexpr double kRival = 0.85;  // a peak of so much of the best one's score may be the right one
constexpr int kPeaks = 3;
constexpr int kSteps = 4;
constexpr double kStill_px = 0.01;  // of the fine level: steps below it are not worth another
constexpr int kRounds = 5;

// A frame's detail at its place on a mosaic: the fraction of the shift by resampling, the rest by `at`.
struct Placed {
  cv::Mat detail;
  cv::Point at;

  Placed(const cv::Mat& level, cv::Point2d shift_px, int margin_px) {
    const cv::Point whole(cvRound(shift_px.x), cvRound(shift_px.y));
    detail = Translated(level, shift_px - cv::Point2d(whole));
    at = cv::Point(margin_px, margin_px) - whole;
  }
  cv::Rect area() const { return {at, detail.size()}; }
  bool Within(const cv::Mat& canvas) const { return (area() & cv::Rect({0, 0}, canvas.size())) == area(); }
};

double CorrelationOf(const cv::Mat& detail, const MosaicPart& part) {
  const double energies =
      cv::norm(detail, cv::NORM_L2SQR, part.frames > 0) * cv::norm(part.mean, cv::NORM_L2SQR);
  return energies > 0 ? detail.dot(part.mean) / std::sqrt(energies) : 0;
}

}  // namespace

Alignment::Alignment(cv::Size fine, cv::Size coarse, int ratio, int margin_px)
    : ratio_(ratio),
      margin_px_(margin_px),
      fine_size_(fine),
      coarse_size_(coarse),
      fine_(fine, margin_px * ratio),
      coarse_(coarse, margin_px) {}

Alignment Alignment::Empty() const { return {fine_size_, coarse_size_, ratio_, margin_px_}; }

void Alignment::Add(const FrameDetail& detail, cv::Point2d fine_px) {
  const Placed fine(detail.fine, fine_px, fine_.margin_px()),
      coarse(detail.coarse, fine_px / ratio_, coarse_.margin_px());
  fine_.Add(fine.detail, fine.at);
  coarse_.Add(coarse.detail, coarse.at);
}

std::optional<Fit> Alignment::Search(const FrameDetail& detail) const {
  std::optional<Fit> best;
  const std::vector<ShiftPeak> peaks = BestShifts(detail.coarse, coarse_, kPeaks);
  for (const ShiftPeak& peak : peaks) {
    if (peak.clearness < kRival * peaks.front().clearness) break;
    std::optional<Fit> fit = Refined(detail.fine, peak.shift_px * ratio_);
    if (!fit || (best && best->correlation >= fit->correlation)) continue;
    best = fit;
    best->clearness = peak.clearness;
  }
  return best;
}

std::optional<Fit> Alignment::Refined(const cv::Mat& fine_detail, cv::Point2d from_px,
                                      std::optional<cv::Point2d> added_px) const {
  std::optional<Placed> own;
  if (added_px) own.emplace(fine_detail, *added_px, fine_.margin_px());
  Fit fit{.fine_px = from_px, .common = {}};
  for (int step = 0; step < kSteps; ++step) {
    const Placed placed(fine_detail, fit.fine_px, fine_.margin_px());
    if (!placed.Within(fine_.whole().mean)) return {};
    const MosaicPart part =
        own ? fine_.PartWithout(placed.area(), own->detail, own->at) : fine_.Part(placed.area());
    fit.correlation = CorrelationOf(placed.detail, part);
    fit.common = CommonShiftOf(BlockShifts(placed.detail, part.mean, part.frames));
    const cv::Point2d moved = fit.common.shift_px;
    if (!std::isfinite(moved.x) || !std::isfinite(moved.y)) return {};
    fit.fine_px += moved;
    if (cv::norm(moved) < kStill_px) break;
  }
  if (!Placed(fine_detail, fit.fine_px, fine_.margin_px()).Within(fine_.whole().mean)) return {};
  return fit;
}

void AlignTogether(const std::vector<FrameDetail>& details, std::vector<Fit>& fits, Alignment& alignment) {
  const int count = static_cast<int>(details.size());
  for (int round = 0;; ++round) {
    alignment = alignment.Empty();
    for (size_t k = 0; k < details.size(); ++k) alignment.Add(details[k], fits[k].fine_px);
    if (round == kRounds || count < 2) return;
    std::vector<Fit> next = fits;  // of each to the others as they were, so that threads change nothing
    tbb::parallel_for(0, count, [&](int i) {
      const auto k = static_cast<size_t>(i);
      auto fit = alignment.Refined(details[k].fine, fits[k].fine_px, fits[k].fine_px);
      if (fit) fit->clearness = fits[k].clearness, next[k] = *fit;
    });
    const cv::Point2d origin = next.front().fine_px;
    double most = 0;
    for (size_t k = 0; k < next.size(); ++k) {
      next[k].fine_px -= origin;
      most = std::max(most, cv::norm(next[k].fine_px - fits[k].fine_px));
    }
    fits = next;
    if (most < kStill_px) round = kRounds - 1;  // once more, for the mosaic
  }
}

}  // namespace shimmer::restore
