#include "restore/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/restore/frames.h"

namespace shimmer::restore {
namespace {

struct Case {
  cv::Size frame;
  int side_px, overlap_px;
};

const Case kCases[] = {{{1920, 1080}, 384, 32}, {{100, 70}, 64, 16}, {{97, 65}, 64, 31}, {{64, 64}, 64, 8},
                       {{65, 64}, 64, 8},       {{30, 200}, 64, 0},  {{1, 1}, 64, 16},   {{3, 129}, 8, 3}};

TEST(Tiles, CoverTheFrameAndOverlap) {
  for (const Case& c : kCases) {
    const std::vector<cv::Rect> tiles = Tiles(c.frame, c.side_px, c.overlap_px);
    cv::Mat covered = cv::Mat::zeros(c.frame, CV_8UC1);
    std::vector<int> columns, rows;
    for (const cv::Rect& tile : tiles) {
      EXPECT_EQ(tile.size(),
                cv::Size(std::min(c.side_px, c.frame.width), std::min(c.side_px, c.frame.height)));
      ASSERT_EQ(tile & cv::Rect({}, c.frame), tile);
      covered(tile) = 255;
      if (tile.y == 0) columns.push_back(tile.x);
      if (tile.x == 0) rows.push_back(tile.y);
    }
    EXPECT_EQ(cv::countNonZero(covered), c.frame.area());
    EXPECT_EQ(columns.size() * rows.size(), tiles.size());
    for (const std::vector<int>& starts : {columns, rows})
      for (size_t k = 1; k < starts.size(); ++k)
        EXPECT_LE(starts[k], starts[k - 1] + c.side_px - c.overlap_px);
  }
}

// One less would not do: the last begins where the frame lets it.
TEST(Tiles, AreNoMoreThanNeeded) {
  EXPECT_EQ(Tiles({64, 64}, 64, 16).size(), 1u);
  EXPECT_EQ(Tiles({65, 64}, 64, 16).size(), 2u);
  EXPECT_EQ(Tiles({112, 64}, 64, 16).size(), 2u);  // 64 + 64 - 16
  EXPECT_EQ(Tiles({113, 64}, 64, 16).size(), 3u);
}

// Float sums of at most four weights: 1e-6 of the value.
TEST(Tiles, OfAPictureAddUpToIt) {
  for (const Case& c : kCases) {
    const cv::Mat frame = Noise(c.frame, CV_32FC3, 3);
    TileSum sum(c.frame, c.overlap_px);
    for (const cv::Rect& tile : Tiles(c.frame, c.side_px, c.overlap_px)) sum.Add(frame(tile), tile);
    EXPECT_LE(cv::norm(sum.Whole(), frame, cv::NORM_INF), 1e-6) << c.frame;
  }
}

// What differs by 1 between two tiles goes over from one to the other in steps of no more than 1 / overlap.
TEST(Tiles, FadeIntoOneAnother) {
  const cv::Size frame{100, 40};
  const int overlap_px = 16;
  TileSum sum(frame, overlap_px);
  float level = 0;
  for (const cv::Rect& tile : Tiles(frame, 64, overlap_px))
    sum.Add(cv::Mat(tile.size(), CV_32FC1, cv::Scalar::all(level++)), tile);
  const cv::Mat whole = sum.Whole();
  EXPECT_EQ(whole.at<float>(20, 0), 0);
  EXPECT_EQ(whole.at<float>(20, 99), 1);
  for (int x = 1; x < frame.width; ++x) {
    const float step = whole.at<float>(20, x) - whole.at<float>(20, x - 1);
    EXPECT_GE(step, 0);
    EXPECT_LE(step, 1.2f / overlap_px);
  }
}

TEST(Tiles, RefuseToOverlapByHalf) {
  EXPECT_THROW(Tiles({100, 100}, 64, 32), std::invalid_argument);
  EXPECT_THROW(Tiles({100, 100}, 64, -1), std::invalid_argument);
  EXPECT_THROW(Tiles({100, 100}, 0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
