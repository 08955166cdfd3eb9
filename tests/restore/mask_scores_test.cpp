#include "restore/mask_scores.h"

#include <gtest/gtest.h>

#include "tests/restore/frames.h"

namespace shimmer::restore {
namespace {

cv::Mat Filled(cv::Size size, cv::Rect area, int type = CV_8UC1) {
  cv::Mat mask = cv::Mat::zeros(size, type);
  mask(area).setTo(cv::Scalar::all(WhiteOf(CV_MAT_DEPTH(type))));
  return mask;
}

// 6x4 and 6x4 px, 3x4 of them shared; of any type.
TEST(MaskScores, OfTwoBoxes) {
  for (const int type : {CV_8UC1, CV_16UC3, CV_32FC1}) {
    const MaskCounts counts =
        CompareMasks(Filled({20, 70}, {2, 30, 6, 4}, type), Filled({20, 70}, {5, 30, 6, 4}));
    EXPECT_EQ(counts.both, 12);
    EXPECT_EQ(counts.only_found, 12);
    EXPECT_EQ(counts.only_true, 12);
    EXPECT_DOUBLE_EQ(counts.Iou(), 12.0 / 36);
    EXPECT_DOUBLE_EQ(counts.Precision(), 0.5);
    EXPECT_DOUBLE_EQ(counts.Recall(), 0.5);
  }
}

TEST(MaskScores, PrecisionIsOfTheFoundAndRecallOfTheTrue) {
  const MaskCounts counts = CompareMasks(Filled({9, 9}, {0, 0, 2, 2}), Filled({9, 9}, {0, 0, 4, 4}));
  EXPECT_EQ(counts.Precision(), 1);
  EXPECT_EQ(counts.Recall(), 0.25);
  EXPECT_EQ(counts.Iou(), 0.25);
}

TEST(MaskScores, OfEmptyMasks) {
  const cv::Mat empty = cv::Mat::zeros(5, 3, CV_8UC1), box = Filled({3, 5}, {0, 0, 1, 1});
  const MaskCounts both_empty = CompareMasks(empty, empty), nothing_found = CompareMasks(empty, box),
                   nothing_true = CompareMasks(box, empty);
  EXPECT_EQ(both_empty.Iou(), 1);
  EXPECT_EQ(both_empty.Precision(), 1);
  EXPECT_EQ(both_empty.Recall(), 1);
  EXPECT_EQ(nothing_found.Iou(), 0);
  EXPECT_EQ(nothing_found.Precision(), 1);
  EXPECT_EQ(nothing_found.Recall(), 0);
  EXPECT_EQ(nothing_true.Iou(), 0);
  EXPECT_EQ(nothing_true.Precision(), 0);
  EXPECT_EQ(nothing_true.Recall(), 1);
}

TEST(MaskScores, AddUp) {
  MaskCounts sum = CompareMasks(Filled({4, 4}, {0, 0, 4, 1}), Filled({4, 4}, {0, 0, 4, 1}));
  sum += CompareMasks(Filled({4, 4}, {0, 0, 4, 3}), Filled({4, 4}, {0, 0, 4, 0}));
  EXPECT_EQ(sum.Precision(), 4.0 / 16);
}

// Half of white moves, less does not; of RGB the mean.
TEST(MovingPixels, AreAtLeastHalfWhite) {
  const cv::Mat bytes = (cv::Mat_<uint8_t>(1, 4) << 0, 127, 128, 255),
                expected = (cv::Mat_<uint8_t>(1, 4) << 0, 0, 255, 255);
  EXPECT_EQ(cv::norm(MovingPixels(bytes), expected, cv::NORM_INF), 0);
  const cv::Mat floats = (cv::Mat_<float>(1, 4) << 0.0f, 0.499f, 0.5f, 7.0f);
  EXPECT_EQ(cv::norm(MovingPixels(floats), expected, cv::NORM_INF), 0);
  EXPECT_EQ(cv::countNonZero(MovingPixels(cv::Mat(2, 2, CV_8UC3, cv::Scalar(255, 0, 0)))), 0);
  EXPECT_EQ(cv::countNonZero(MovingPixels(cv::Mat(2, 2, CV_8UC3, cv::Scalar(255, 255, 0)))), 4);
}

TEST(MaskScores, RefuseWhatIsNoMask) {
  const cv::Mat mask = cv::Mat::zeros(4, 4, CV_8UC1);
  EXPECT_THROW(CompareMasks(mask, cv::Mat::zeros(4, 5, CV_8UC1)), std::invalid_argument);
  EXPECT_THROW(CompareMasks({}, mask), std::invalid_argument);
  EXPECT_THROW(MovingPixels(cv::Mat(4, 4, CV_8UC2)), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
