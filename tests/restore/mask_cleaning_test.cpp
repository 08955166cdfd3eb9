#include "restore/mask_cleaning.h"

#include <gtest/gtest.h>

namespace shimmer::restore {
namespace {

cv::Mat Boxes(const std::vector<cv::Rect>& boxes) {
  cv::Mat mask = cv::Mat::zeros(41, 61, CV_8UC1);
  for (const cv::Rect& box : boxes) mask(box).setTo(255);
  return mask;
}

void ExpectSame(const cv::Mat& found, const cv::Mat& expected) {
  EXPECT_EQ(cv::norm(found, expected, cv::NORM_INF), 0);
}

constexpr int kX = 5, kY = 7;  // of the small box

TEST(MaskCleaning, ObjectsHoldSoManyPixelsOfThePlaces) {
  const cv::Rect small(kX, kY, 4, 5), large(30, 20, 10, 9);
  const cv::Mat both = Boxes({small, large}), nowhere = Boxes({});
  ExpectSame(Holding(both, both, 20), both);
  ExpectSame(Holding(both, both, 21), Boxes({large}));
  ExpectSame(Holding(both, both, 91), nowhere);
  ExpectSame(Holding(both, nowhere, 1), nowhere);
  ExpectSame(Holding(both, Boxes({{kX + 3, kY + 4, 20, 3}}), 1), Boxes({small}));  // its last pixel
  ExpectSame(Holding(both, Boxes({{kX + 4, kY + 5, 20, 3}}), 1), nowhere);         // beside it
}

TEST(MaskCleaning, WhatIsInOneFrameAloneGoes) {
  const cv::Rect small(kX, kY, 4, 5);
  const cv::Mat mask = Boxes({small}), none = Boxes({}), moved = Boxes({{kX + 6, kY, 4, 5}});
  ExpectSame(Persistent(mask, none, none, 3), none);
  ExpectSame(Persistent(mask, none, moved, 3), mask);  // its near side is 3 px from the small one's far side
  ExpectSame(Persistent(mask, moved, none, 2), none);
  ExpectSame(Persistent(mask, {}, {}, 3), mask);  // there is nothing to tell by
}

TEST(MaskCleaning, ObjectsAreSureLargeAndWhole) {
  cv::Mat distance = cv::Mat::zeros(41, 61, CV_32FC1);
  const cv::Rect left(5, 10, 6, 9), right(15, 10, 6, 9);  // a gap of 4 px
  distance(left).setTo(2), distance(right).setTo(2);
  const cv::Mat sure = Boxes({{6, 11, 1, 1}});
  const cv::Mat objects = MovingObjects(distance, 1, sure, 20);
  EXPECT_EQ(objects.at<uint8_t>(14, 18), 255);
  EXPECT_EQ(objects.at<uint8_t>(14, 13), 255);
  EXPECT_EQ(cv::countNonZero(MovingObjects(distance, 2, sure, 20)), 0);       // not beyond it
  EXPECT_EQ(cv::countNonZero(MovingObjects(distance, 1, Boxes({}), 20)), 0);  // nothing is sure
  EXPECT_EQ(cv::countNonZero(MovingObjects(distance, 1, sure, 1000)), 0);
}

}  // namespace
}  // namespace shimmer::restore
