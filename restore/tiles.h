// Tiles of one size that cover a frame and overlap, and how they are put together again without seams.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::restore {

// In rows from the top left. Tiles have side_px, or the frame's side where that is less; neighbours share
// overlap_px or more: they are spread evenly. Throws std::invalid_argument unless 0 <= 2 overlap < side.
std::vector<cv::Rect> Tiles(cv::Size frame, int side_px, int overlap_px);

// Adds what is made of each tile of a frame to the whole, weighted: from 0 at an edge that another tile
// reaches over, to 1 overlap_px inside of it. Where tiles meet, one is faded into the other.
class TileSum {
 public:
  // tiles: Tiles(frame, ..., overlap_px).
  TileSum(cv::Size frame, int overlap_px);

  // tile: CV_32FC1 or CV_32FC3, of place's size, the same type for all.
  void Add(const cv::Mat& tile, cv::Rect place);
  // The weighted mean. Once all tiles are added.
  cv::Mat Whole() const;

 private:
  cv::Size frame_;
  int overlap_px_;
  cv::Mat sum_, weights_;
};

}  // namespace shimmer::restore
