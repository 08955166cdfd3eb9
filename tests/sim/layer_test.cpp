#include "sim/layer.h"

#include <gtest/gtest.h>

namespace shimmer::sim {
namespace {

Layer Block(cv::Rect area, const cv::Vec4f& value) {
  return {area, cv::Mat(area.size(), CV_32FC4, cv::Scalar(value))};
}

// Half covered by red of 0.8: 0.4 + half of what was there; as far as it is seen.
TEST(Layer, LiesOverWhatWasThere) {
  for (const int channels : {3, 1}) {
    cv::Mat frame(6, 8, CV_32FC(channels), cv::Scalar::all(0.5)), mask = cv::Mat::zeros(6, 8, CV_32FC1);
    Composite(Block({-1, 1, 4, 9}, {0.4f, 0, 0, 0.5f}), {-2, -1}, frame, mask);  // pixel (0, 0) is (-2, -1)
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 8; ++x) {
        const bool covered = x >= 1 && x < 5 && y >= 2;
        EXPECT_FLOAT_EQ(mask.at<float>(y, x), covered ? 0.5f : 0) << x << " " << y;
        const float red = covered ? 0.4f + 0.25f : 0.5f, blue = covered ? 0.25f : 0.5f;
        if (channels == 3) {
          EXPECT_FLOAT_EQ(frame.at<cv::Vec3f>(y, x)[0], red);
          EXPECT_FLOAT_EQ(frame.at<cv::Vec3f>(y, x)[2], blue);
        } else {
          EXPECT_FLOAT_EQ(frame.at<float>(y, x), covered ? 0.4f / 3 + 0.25f : 0.5f);
        }
      }
  }
}

TEST(Layer, TwoOfThemCoverTogether) {
  cv::Mat frame = cv::Mat::zeros(1, 1, CV_32FC3), mask = cv::Mat::zeros(1, 1, CV_32FC1);
  for (int i = 0; i < 2; ++i) Composite(Block({0, 0, 1, 1}, {0, 0.5f, 0, 0.5f}), {0, 0}, frame, mask);
  EXPECT_FLOAT_EQ(mask.at<float>(0, 0), 0.75f);
  EXPECT_FLOAT_EQ(frame.at<cv::Vec3f>(0, 0)[1], 0.75f);
}

TEST(Layer, OutsideOfTheFrameIsNothing) {
  cv::Mat frame(3, 3, CV_32FC3, cv::Scalar::all(0.25)), mask = cv::Mat::zeros(3, 3, CV_32FC1);
  const cv::Mat before = frame.clone();
  Composite(Block({3, 0, 5, 5}, {1, 1, 1, 1}), {0, 0}, frame, mask);
  Composite({}, {0, 0}, frame, mask);
  EXPECT_EQ(cv::norm(frame, before, cv::NORM_INF), 0);
  EXPECT_EQ(cv::countNonZero(mask), 0);
  cv::Mat bytes(3, 3, CV_8UC3);
  EXPECT_THROW(Composite({}, {0, 0}, bytes, mask), std::invalid_argument);
}

TEST(LayerMean, IsThatOverAllTimes) {
  LayerMean mean;
  mean.Add(Block({0, 0, 2, 1}, {1, 1, 1, 1}));
  mean.Add(Block({1, 0, 2, 1}, {1, 1, 1, 1}));
  mean.Add({});  // not there at the third
  const Layer layer = mean.Mean();
  EXPECT_EQ(layer.area, cv::Rect(0, 0, 3, 1));
  const float expected[] = {1 / 3.f, 2 / 3.f, 1 / 3.f};
  for (int x = 0; x < 3; ++x) EXPECT_FLOAT_EQ(layer.rgba.at<cv::Vec4f>(0, x)[3], expected[x]);
  LayerMean none;
  none.Add({});
  EXPECT_TRUE(none.Mean().area.empty());
}

}  // namespace
}  // namespace shimmer::sim
