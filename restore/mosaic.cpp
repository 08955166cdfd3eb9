#include "restore/mosaic.h"

namespace shimmer::restore {

Mosaic::Mosaic(cv::Size frame, int margin_px)
    : margin_px_(margin_px),
      sum_(cv::Mat::zeros(frame.height + 2 * margin_px, frame.width + 2 * margin_px, CV_32FC1)),
      frames_(sum_.clone()),
      mean_(sum_.clone()) {}

void Mosaic::Add(const cv::Mat& detail, cv::Point at) {
  const cv::Rect inner(kRim_px, kRim_px, detail.cols - 2 * kRim_px, detail.rows - 2 * kRim_px);
  if (inner.width <= 0 || inner.height <= 0) return;
  const cv::Rect area = inner + at;
  cv::Mat sum = sum_(area), frames = frames_(area), mean = mean_(area);
  sum += detail(inner);
  frames += 1;
  cv::divide(sum, frames, mean);
}

}  // namespace shimmer::restore
