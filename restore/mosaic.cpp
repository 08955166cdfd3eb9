#include "restore/mosaic.h"

#include <algorithm>

namespace shimmer::restore {
namespace {

// What of a frame's detail is used.
cv::Rect Inner(const cv::Mat& detail) {
  constexpr int kRim = Mosaic::kRim_px;
  return {kRim, kRim, std::max(0, detail.cols - 2 * kRim), std::max(0, detail.rows - 2 * kRim)};
}

}  // namespace

Mosaic::Mosaic(cv::Size frame, int margin_px)
    : margin_px_(margin_px),
      sum_(cv::Mat::zeros(frame.height + 2 * margin_px, frame.width + 2 * margin_px, CV_32FC1)),
      whole_{sum_.clone(), sum_.clone()} {}

void Mosaic::Add(const cv::Mat& detail, cv::Point at) {
  const cv::Rect inner = Inner(detail), area = inner + at;
  if (inner.empty()) return;
  cv::Mat sum = sum_(area), frames = whole_.frames(area), mean = whole_.mean(area);
  sum += detail(inner);
  frames += 1;
  cv::divide(sum, frames, mean);
}

MosaicPart Mosaic::Part(cv::Rect area) const { return {whole_.mean(area), whole_.frames(area)}; }

MosaicPart Mosaic::PartWithout(cv::Rect area, const cv::Mat& detail, cv::Point at) const {
  cv::Mat sum = sum_(area).clone(), frames = whole_.frames(area).clone(), mean;
  const cv::Rect own = (Inner(detail) + at) & area;
  if (!own.empty()) {
    cv::Mat own_sum = sum(own - area.tl()), own_frames = frames(own - area.tl());
    own_sum -= detail(own - at);
    own_frames -= 1;
  }
  cv::divide(sum, cv::max(frames, 1), mean);
  mean.setTo(0, frames == 0);  // (where rounding has left a rest)
  return {mean, frames};
}

}  // namespace shimmer::restore
