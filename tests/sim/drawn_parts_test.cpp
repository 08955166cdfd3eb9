// What drawn scenes are made of: waves and letters.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "sim/drawn/letters.h"
#include "sim/drawn/waves.h"

namespace shimmer::sim {
namespace {

TEST(Waves, EqualTheirDefinitions) {
  for (int i = -1000; i <= 1000; ++i) {
    const double u = i * 0.00437;
    EXPECT_NEAR(CosTurns(u), std::cos(2 * std::numbers::pi * u), 1e-11) << u;
    const double x = std::cos(u), y = std::sin(u);
    EXPECT_NEAR(AngleTurns(x, y), std::atan2(y, x) / (2 * std::numbers::pi), 1e-10) << u;
  }
  EXPECT_EQ(AngleTurns(0, 0), 0);
  EXPECT_EQ(AngleTurns(0, -3), -0.25);
  EXPECT_EQ(AngleTurns(-3, 0), 0.5);
}

TEST(Waves, CoverPixelsExactly) {
  for (const double width : {0.01, 0.3, 0.5, 1.0, 1.7}) {
    for (double turns = -1.3; turns < 1.3; turns += 0.0831) {
      int light = 0;
      const int steps = 20000;
      for (int i = 0; i < steps; ++i) {
        const double u = turns + width * ((i + 0.5) / steps - 0.5);
        light += u - std::floor(u) < 0.5;
      }
      // Up to four edges within the pixel, each counted to a step.
      EXPECT_NEAR(SquareCoverage(turns, width), double(light) / steps, 4.0 / steps) << turns << " " << width;
    }
  }
}

TEST(Text, BreaksIntoLinesThatFit) {
  const std::string words = "Over a hot road the far end of the street begins to swim";
  const auto lines = WrapWords(words, Face::kSerif, 9, 120);
  ASSERT_GT(lines.size(), 2u);
  std::string joined;
  for (const std::string& line : lines) {
    EXPECT_LE(TextWidth(line, Face::kSerif, 9), 120);
    joined += (joined.empty() ? "" : " ") + line;
  }
  EXPECT_EQ(joined, words);
  EXPECT_EQ(WrapWords("ab c", Face::kSans, 9, 0), (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(WrapWords(" a   b ", Face::kSans, 9, 100), std::vector<std::string>{"a   b"});
  EXPECT_TRUE(WrapWords("  ", Face::kSans, 9, 100).empty());
}

TEST(Text, HasCapitalsOfTheirHeightOnTheBaseline) {
  for (const double capital_px : {9.0, 30.0}) {
    const Lettering letters = DrawLetters("H", Face::kSans, capital_px, {20.25, 50});
    double ink_top = 1e9, ink_bottom = -1e9;
    for (int y = 0; y < letters.coverage.rows; ++y) {
      double low, high;
      cv::minMaxLoc(letters.coverage.row(y), &low, &high);
      if (high < 0.5) continue;
      ink_top = std::min<double>(ink_top, letters.corner.y + y);
      ink_bottom = std::max<double>(ink_bottom, letters.corner.y + y);
    }
    // To a pixel, and half a stroke at either end.
    EXPECT_NEAR(ink_bottom, 50, 1 + 0.06 * capital_px);
    EXPECT_NEAR(ink_top, 50 - capital_px, 1 + 0.06 * capital_px);
  }
}

TEST(Text, IsCutAtTheImagesEdge) {
  cv::Mat image(10, 10, CV_8UC3, cv::Scalar::all(255));
  for (const cv::Point2d origin :
       {cv::Point2d(-30, 5), cv::Point2d(8, 12), cv::Point2d(500, 500), cv::Point2d(-500, -9)})
    Stamp<uchar>(image, DrawLetters("Heat", Face::kSerifBold, 9, origin), {0, 0, 0});
  double low, high;
  cv::minMaxLoc(image.reshape(1), &low, &high);
  EXPECT_LT(low, 128);  // some of it did fall inside
}

}  // namespace
}  // namespace shimmer::sim
