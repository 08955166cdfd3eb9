#include "restore/stability.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "restore/levels.h"

namespace shimmer::restore {

std::optional<double> FrameDifference(const cv::Mat& before, const cv::Mat& frame, const cv::Mat& moving) {
  const int channels = RequireFramePair(before, frame);
  if (!moving.empty() && (moving.type() != CV_8UC1 || moving.size() != frame.size()))
    throw std::invalid_argument("moving: must be CV_8UC1 of the frames' size");
  double sum = 0;
  int64_t count = 0;
  ForRows(frame.rows, [&](cv::Range rows) {
    const cv::Mat earlier = Levels(before, rows, channels), later = Levels(frame, rows, channels);
    for (int y = rows.start; y < rows.end; ++y) {
      const uint8_t* moves = moving.empty() ? nullptr : moving.ptr(y);
      const auto *from = earlier.ptr<double>(y - rows.start), *to = later.ptr<double>(y - rows.start);
      for (int x = 0; x < frame.cols; ++x) {
        if (moves && moves[x]) continue;
        count += channels;
        for (int i = x * channels; i < (x + 1) * channels; ++i) sum += std::abs(to[i] - from[i]);
      }
    }
  });
  if (count == 0) return {};
  return sum / static_cast<double>(count);
}

void TimeSlice::Add(const cv::Mat& frame) {
  RequireFrame(frame, "frame");
  if (y_ < 0 || y_ >= frame.rows)
    throw std::invalid_argument("row = " + std::to_string(y_) + ", must be in [0, " +
                                std::to_string(frame.rows - 1) + "]");
  if (!picture_.empty() && (picture_.type() != frame.type() || picture_.cols != frame.cols))
    throw std::invalid_argument("frame: is of another type or width than the first");
  picture_.push_back(frame.row(y_));
}

}  // namespace shimmer::restore
