// How steady a sequence is where nothing moves.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

namespace shimmer::restore {

// The mean, over the pixels that do not move and over channels, of |frame - frame before| in levels
// (levels.h). moving: CV_8UC1 of the same size, not 0 where something moves in either frame
// (MovingPixels(one) | MovingPixels(other)); empty where nothing does. Nothing where everything moves. Throws
// std::invalid_argument for what are no frames or not of one size.
std::optional<double> FrameDifference(const cv::Mat& before, const cv::Mat& frame, const cv::Mat& moving);

// One row of a sequence over time, as a picture: row t is the row of frame t. Things that stand still are
// straight lines down; the shimmer makes them wavy.
class TimeSlice {
 public:
  // y: of the row, in px from the top.
  explicit TimeSlice(int y) : y_(y) {}

  // The next frame. Throws std::invalid_argument for what is no frame, has no such row, or has another type
  // or width than the first.
  void Add(const cv::Mat& frame);

  // As wide as the frames and as high as their number, of their type; empty before the first.
  const cv::Mat& picture() const { return picture_; }

 private:
  int y_;
  cv::Mat picture_;
};

}  // namespace shimmer::restore
