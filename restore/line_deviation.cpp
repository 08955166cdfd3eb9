#include "restore/line_deviation.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "restore/levels.h"

namespace shimmer::restore {
namespace {

cv::Mat Grey8(const cv::Mat& frame) {
  RequireFrame(frame, "frame");
  cv::Mat grey(frame.size(), CV_8UC1);
  const int channels = frame.channels();
  ForRows(frame.rows, [&](cv::Range rows) {
    const cv::Mat levels = Levels(frame, rows, channels);
    for (int y = rows.start; y < rows.end; ++y) {
      const auto* samples = levels.ptr<double>(y - rows.start);
      for (int x = 0; x < frame.cols; ++x, samples += channels)
        grey.at<uint8_t>(y, x) = cv::saturate_cast<uint8_t>(
            channels == 1 ? samples[0] : 0.299 * samples[0] + 0.587 * samples[1] + 0.114 * samples[2]);
    }
  });
  return grey;
}

}  // namespace

double AxisDeviation_deg(cv::Point from, cv::Point to) {
  const double along_x = std::abs(to.x - from.x), along_y = std::abs(to.y - from.y);
  return std::atan2(std::min(along_x, along_y), std::max(along_x, along_y)) * 180 / CV_PI;
}

std::optional<double> LineDeviation_deg(const cv::Mat& frame, const LineSearch& search) {
  cv::Mat edges;
  cv::Canny(Grey8(frame), edges, search.canny_low, search.canny_high);
  std::vector<cv::Vec4i> segments;
  cv::HoughLinesP(edges, segments, search.distance_step_px, search.angle_step_deg * CV_PI / 180, search.votes,
                  search.min_length_px, search.max_gap_px);
  if (segments.empty()) return {};
  double sum_deg = 0;
  for (const cv::Vec4i& ends : segments) sum_deg += AxisDeviation_deg({ends[0], ends[1]}, {ends[2], ends[3]});
  return sum_deg / static_cast<double>(segments.size());
}

}  // namespace shimmer::restore
