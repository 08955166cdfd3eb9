// A network that is none, and does what can be checked.
#pragma once

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "restore/sharpening_network.h"

namespace shimmer::restore {

// Unsharp masking by a box: as a network it has a reach, which tiles cut.
class BoxSharpening : public SharpeningNetwork {
 public:
  explicit BoxSharpening(TileSize tile = {.side_px = 64, .overlap_px = 16}) : tile_(tile) {}

  std::string name() const override { return "box"; }
  TileSize tile() const override { return tile_; }
  cv::Mat Sharpened(const cv::Mat& picture) override {
    EXPECT_EQ(picture.type(), CV_32FC3);
    ++calls;
    cv::Mat soft;
    cv::blur(picture, soft, {3, 3});
    return picture + 0.5 * (picture - soft);
  }

  int calls = 0;

 private:
  TileSize tile_;
};

}  // namespace shimmer::restore
