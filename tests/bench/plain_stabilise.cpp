#include "tests/bench/plain_stabilise.h"

#include <opencv2/imgproc.hpp>

namespace shimmer::bench {

std::vector<cv::Point2d> PlainShifts(const std::vector<cv::Mat>& frames, int border_px) {
  double mean = 0;
  for (const cv::Mat& frame : frames) mean += cv::mean(frame)[0] / static_cast<double>(frames.size());
  const cv::Mat reference = frames.front() - mean;
  const cv::Rect inner(border_px, border_px, reference.cols - 2 * border_px, reference.rows - 2 * border_px);
  std::vector<cv::Point2d> shifts;
  for (const cv::Mat& frame : frames) {
    const cv::Mat cropped = frame(inner) - mean;
    cv::Mat correlation;
    cv::matchTemplate(reference, cropped, correlation, cv::TM_CCORR);
    cv::Point at;
    cv::minMaxLoc(correlation, nullptr, nullptr, nullptr, &at);
    shifts.emplace_back(inner.tl() - at);
  }
  return shifts;
}

}  // namespace shimmer::bench
