#include "restore/line_deviation.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tests/restore/frames.h"

namespace shimmer::restore {
namespace {

// White on one side of an edge through the middle, whose direction is turned by this from upright; the edge
// is one px wide.
cv::Mat Edge(int side, double turned_deg, int type = CV_8UC1) {
  cv::Mat frame(side, side, CV_64FC1), result;
  const double cosine = std::cos(turned_deg * CV_PI / 180), sine = std::sin(turned_deg * CV_PI / 180);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      frame.at<double>(y, x) =
          std::clamp((x - side / 2.0) * cosine + (y - side / 2.0) * sine + 0.5, 0.0, 1.0) *
          WhiteOf(CV_MAT_DEPTH(type));
  frame.convertTo(result, CV_MAT_DEPTH(type));
  if (CV_MAT_CN(type) == 3) cv::merge(std::vector(3, result), result);
  return result;
}

TEST(AxisDeviation, IsToTheNearerAxis) {
  EXPECT_EQ(AxisDeviation_deg({3, 5}, {90, 5}), 0);
  EXPECT_EQ(AxisDeviation_deg({3, 5}, {3, -70}), 0);
  EXPECT_NEAR(AxisDeviation_deg({0, 0}, {40, 40}), 45, 1e-12);
  for (const cv::Point to : {cv::Point(3, 4), cv::Point(4, 3), cv::Point(-3, 4), cv::Point(-4, -3)}) {
    EXPECT_NEAR(AxisDeviation_deg({0, 0}, to), std::atan(0.75) * 180 / CV_PI, 1e-12);
    EXPECT_EQ(AxisDeviation_deg(to, {0, 0}), AxisDeviation_deg({0, 0}, to));
  }
}

TEST(LineDeviation, OfUprightAndLevelEdgesIsZero) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_32FC3}) {
    EXPECT_EQ(LineDeviation_deg(Edge(200, 0, type)), 0);
    EXPECT_EQ(LineDeviation_deg(Edge(200, 90, type)), 0);
  }
}

// The transform breaks a long edge into segments along steps of whole px; each is known within atan(1/50) or
// so, their mean better.
TEST(LineDeviation, OfATurnedEdgeIsItsAngle) {
  for (const double turned_deg : {2.0, 5.0, 20.0, 45.0, 70.0, 88.0, 93.0, 178.0}) {
    const auto deviation = LineDeviation_deg(Edge(400, turned_deg));
    ASSERT_TRUE(deviation) << turned_deg;
    EXPECT_NEAR(*deviation, std::abs(turned_deg - 90 * std::round(turned_deg / 90)), 0.6) << turned_deg;
  }
}

// A straight edge that is made wavy deviates more.
TEST(LineDeviation, GrowsAsAnEdgeBends) {
  double last = -1;
  for (const double amplitude_px : {0.0, 2.0, 5.0}) {
    const cv::Mat straight = Edge(300, 0);
    cv::Mat bent(straight.size(), straight.type());
    for (int y = 0; y < 300; ++y) {
      const int shift = cvRound(amplitude_px * std::sin(y * 2 * CV_PI / 150));
      for (int x = 0; x < 300; ++x)
        bent.at<uint8_t>(y, x) = straight.at<uint8_t>(y, std::clamp(x + shift, 0, 299));
    }
    const auto deviation = LineDeviation_deg(bent, {.min_length_px = 30});
    ASSERT_TRUE(deviation) << amplitude_px;
    EXPECT_GT(*deviation, last) << amplitude_px;
    last = *deviation;
  }
}

// Red beside the grey of the same brightness (76) has no edge, green (150) has.
TEST(LineDeviation, SeesBrightnessAlone) {
  for (const auto& [colour, seen] :
       {std::pair(cv::Scalar(255, 0, 0), false), std::pair(cv::Scalar(0, 255, 0), true)}) {
    cv::Mat frame(100, 100, CV_8UC3, cv::Scalar::all(76));
    frame.colRange(50, 100).setTo(colour);
    EXPECT_EQ(LineDeviation_deg(frame).has_value(), seen);
  }
}

TEST(LineDeviation, IsAbsentWhereThereIsNoLine) {
  EXPECT_FALSE(LineDeviation_deg(Flat({64, 48}, CV_8UC3, 128)));
  EXPECT_FALSE(LineDeviation_deg(Flat({1, 1}, CV_8UC1, 128)));
  EXPECT_FALSE(LineDeviation_deg(Edge(40, 0)));  // shorter than min_length_px
  EXPECT_TRUE(LineDeviation_deg(Edge(40, 0), {.votes = 20, .min_length_px = 20}));
}

TEST(LineDeviation, IsTheSameOnEveryCallAndThread) {
  cv::Mat frame = Noise({240, 160}, CV_8UC1, 3);
  cv::blur(frame, frame, {5, 5});
  for (int i = 0; i < 12; ++i)
    cv::line(frame, {10 * i, 0}, {239 - 7 * i, 159}, cv::Scalar(i % 2 ? 255 : 0), 2, cv::LINE_AA);
  const auto first = LineDeviation_deg(frame);
  ASSERT_TRUE(first);
  std::vector<std::optional<double>> results(64);
  tbb::parallel_for(size_t{0}, results.size(), [&](size_t i) { results[i] = LineDeviation_deg(frame); });
  for (const auto& result : results) EXPECT_EQ(result, first);
}

TEST(LineDeviation, RefusesWhatIsNoFrame) {
  EXPECT_THROW(LineDeviation_deg({}), std::invalid_argument);
  EXPECT_THROW(LineDeviation_deg(cv::Mat(9, 9, CV_64FC1)), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
