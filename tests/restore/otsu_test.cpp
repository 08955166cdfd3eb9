#include "restore/otsu.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace shimmer::restore {
namespace {

cv::Mat Use(const cv::Mat& values) { return cv::Mat(values.size(), CV_8UC1, cv::Scalar(255)); }

TEST(Otsu, TwoValuesArePartedInTheMiddle) {
  const cv::Mat values = (cv::Mat_<float>(1, 6) << 1.5, 1.5, 1.5, 1.5, 7.5, 7.5);
  PooledHistogram pooled(10, 10);
  pooled.Add(values, Use(values));
  // Every edge from 2 to 7 parts them alike: their mean.
  EXPECT_DOUBLE_EQ(pooled.OtsuThreshold(), 4.5);
  EXPECT_EQ(pooled.Count(), 6);
}

TEST(Otsu, OfThreeValuesTheLargestVarianceBetweenClasses) {
  // Bins 0, 4, 9 with 4, 2, 2 values. Parted after 0: 4 * 4 * 6.5^2 = 676; after 4: 6 * 2 * (9 - 8 / 6)^2 =
  // 705.3.
  const cv::Mat values = (cv::Mat_<float>(1, 8) << 0.5, 0.5, 0.5, 0.5, 4.5, 4.5, 9.5, 9.5);
  PooledHistogram pooled(10, 10);
  pooled.Add(values, Use(values));
  EXPECT_DOUBLE_EQ(pooled.OtsuThreshold(), 7);  // of the edges 5 to 9
}

TEST(Otsu, FramesArePooled) {
  PooledHistogram together(10, 10), apart(10, 10);
  const cv::Mat values = (cv::Mat_<float>(1, 4) << 1, 2, 8, 9);
  together.Add(values, Use(values));
  for (int x = 0; x < 4; ++x) apart.Add(values.col(x), Use(values.col(x)));
  EXPECT_DOUBLE_EQ(apart.OtsuThreshold(), together.OtsuThreshold());
}

TEST(Otsu, WhatIsNotUsedOrNotFiniteDoesNotCount) {
  cv::Mat values = (cv::Mat_<float>(1, 5) << 1.5, 7.5, 3.5, 0, 20);
  values.at<float>(3) = NAN;
  cv::Mat use = Use(values);
  use.at<uint8_t>(2) = 0;
  PooledHistogram pooled(10, 10);
  pooled.Add(values, use);
  EXPECT_EQ(pooled.Count(), 3);  // 20 is in the last bin
  EXPECT_DOUBLE_EQ(pooled.Quantile(1.0), 10);
  EXPECT_DOUBLE_EQ(pooled.Quantile(0.3), 2);
}

TEST(Otsu, NothingToPartIsZero) {
  PooledHistogram pooled(10, 10);
  EXPECT_EQ(pooled.OtsuThreshold(), 0);
  const cv::Mat values(3, 3, CV_32FC1, cv::Scalar(4));
  pooled.Add(values, Use(values));
  EXPECT_EQ(pooled.OtsuThreshold(), 0);
}

TEST(Otsu, BadArguments) {
  EXPECT_THROW(PooledHistogram(0), std::invalid_argument);
  EXPECT_THROW(PooledHistogram(1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
