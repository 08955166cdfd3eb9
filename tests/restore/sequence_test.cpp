// Metrics over time: rolling means, stability, slices.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "restore/rolling.h"
#include "restore/stability.h"
#include "tests/restore/frames.h"

namespace shimmer::restore {
namespace {

using Values = std::vector<std::optional<double>>;

TEST(Rolling, IsOfTheLastFramesThatHaveAValue) {
  const auto rolling = Rolling(Values{{}, 1, 3, {}, 5, 5}, 3);
  ASSERT_EQ(rolling.size(), 6u);
  EXPECT_FALSE(rolling[0]);
  EXPECT_EQ(rolling[1]->mean, 1);
  EXPECT_EQ(rolling[1]->standard_deviation, 0);
  EXPECT_EQ(rolling[2]->mean, 2);
  EXPECT_EQ(rolling[2]->standard_deviation, 1);
  EXPECT_EQ(rolling[3]->mean, 2);  // of 1 and 3
  EXPECT_EQ(rolling[4]->mean, 4);  // of 3 and 5
  EXPECT_EQ(rolling[5]->mean, 5);
  EXPECT_FALSE(Rolling(Values{1, {}, {}}, 2)[2]);
  EXPECT_TRUE(Rolling({}, 1).empty());
  EXPECT_THROW(Rolling(Values{1}, 0), std::invalid_argument);
}

TEST(MeanOfPresent, LeavesOutWhatIsAbsent) {
  EXPECT_EQ(MeanOfPresent(Values{{}, 1, 2, {}}), 1.5);
  EXPECT_FALSE(MeanOfPresent(Values{{}, {}}));
  EXPECT_FALSE(MeanOfPresent({}));
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(MeanOfPresent(Values{1, infinite}), infinite);
}

TEST(FrameDifference, IsInLevelsWhateverTheSamples) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC1})
    for (const double levels : {1.0, 40.0})
      EXPECT_NEAR(*FrameDifference(Flat({13, 66}, type, 200), Flat({13, 66}, type, 200 - levels), {}), levels,
                  2e-5);
  const cv::Mat frame = Noise({31, 33}, CV_8UC3, 1);
  EXPECT_EQ(FrameDifference(frame, frame.clone(), {}), 0);
}

// The left half jumps from black to white and moves, the right differs by 2 levels.
TEST(FrameDifference, IsOfStaticPixelsAlone) {
  cv::Mat before = Flat({20, 40}, CV_8UC3, 0), after = Flat({20, 40}, CV_8UC3, 2),
          moving = cv::Mat::zeros(40, 20, CV_8UC1);
  after.colRange(0, 10).setTo(cv::Scalar::all(255));
  EXPECT_NEAR(*FrameDifference(before, after, {}), (255 + 2) / 2.0, 1e-12);
  moving.colRange(0, 10).setTo(255);
  EXPECT_EQ(FrameDifference(before, after, moving), 2);
  moving.setTo(1);
  EXPECT_FALSE(FrameDifference(before, after, moving));
  EXPECT_THROW(FrameDifference(before, after, cv::Mat(40, 21, CV_8UC1)), std::invalid_argument);
  EXPECT_THROW(FrameDifference(before, after, cv::Mat(40, 20, CV_32FC1)), std::invalid_argument);
  EXPECT_THROW(FrameDifference(before, Flat({20, 41}, CV_8UC3, 2), {}), std::invalid_argument);
}

// The mean of |a - b| of independent uniform samples is a third of the range; of 3e4 samples within 0.003 of
// it.
TEST(FrameDifference, OfNoise) {
  EXPECT_NEAR(*FrameDifference(Noise({100, 100}, CV_32FC3, 2), Noise({100, 100}, CV_32FC3, 3), {}), 85, 1.2);
}

TEST(TimeSlice, HasARowOfEachFrame) {
  TimeSlice slice(2);
  EXPECT_TRUE(slice.picture().empty());
  for (int t = 0; t < 5; ++t) {
    cv::Mat frame = Flat({7, 4}, CV_8UC3, 200);
    frame.row(2).setTo(cv::Scalar(t, 10 * t, 20 * t));
    slice.Add(frame);
  }
  ASSERT_EQ(slice.picture().size(), cv::Size(7, 5));
  ASSERT_EQ(slice.picture().type(), CV_8UC3);
  for (int t = 0; t < 5; ++t)
    for (int x = 0; x < 7; ++x)
      EXPECT_EQ(
          slice.picture().at<cv::Vec3b>(t, x),
          cv::Vec3b(static_cast<uint8_t>(t), static_cast<uint8_t>(10 * t), static_cast<uint8_t>(20 * t)));
  EXPECT_THROW(slice.Add(Flat({8, 4}, CV_8UC3, 0)), std::invalid_argument);
  EXPECT_THROW(slice.Add(Flat({7, 4}, CV_8UC1, 0)), std::invalid_argument);
  EXPECT_THROW(TimeSlice(4).Add(Flat({7, 4}, CV_8UC3, 0)), std::invalid_argument);
  EXPECT_THROW(TimeSlice(-1).Add(Flat({7, 4}, CV_8UC3, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
