#include "sim/motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace shimmer::sim {
namespace {

const cv::Size kFrame{200, 100};

void ExpectAt(const Motion& motion, double time, cv::Point2d place, double tolerance_px = 1e-9) {
  EXPECT_NEAR(cv::norm(motion.At(time).centre - place), 0, tolerance_px) << motion.At(time).centre;
}

TEST(Motion, ALineHasItsSpeedAndDirection) {
  const Motion right({.speed_px = 2.5}, kFrame, 1);
  ExpectAt(right, 0, {99.5, 49.5});  // the middle of the frame
  ExpectAt(right, 4, {109.5, 49.5});
  ExpectAt(right, -0.5, {98.25, 49.5});  // a shutter that opens before the frame's time
  const Motion down({.start_x = 0, .start_y = 1, .speed_px = 1, .direction_deg = 90}, kFrame, 1);
  ExpectAt(down, 0, {-0.5, 99.5});
  ExpectAt(down, 3, {-0.5, 102.5});
}

TEST(Motion, AnArcIsACircleTravelledEvenly) {
  for (const double radius_px : {40.0, -40.0}) {
    const Motion arc({.path = PathKind::kArc, .speed_px = 2, .direction_deg = 0, .radius_px = radius_px},
                     kFrame, 1);
    const cv::Point2d start = arc.At(0).centre, centre = start + cv::Point2d(0, radius_px);
    for (const double time : {0.0, 1.0, 17.3, 90.0})
      EXPECT_NEAR(cv::norm(arc.At(time).centre - centre), 40, 1e-9);
    ExpectAt(arc, 2 * M_PI * 40 / 2, start);                              // once round
    ExpectAt(arc, M_PI * 40 / 2, start + cv::Point2d(0, 2 * radius_px));  // half way
    EXPECT_NEAR(cv::norm(arc.At(1e-4).centre - start - cv::Point2d(2e-4, 0)), 0,
                1e-8);  // sets out to the right
  }
}

TEST(Motion, ASplineGoesThroughItsPointsAtItsSpeedAndStops) {
  const MotionParams params{
      .path = PathKind::kSpline, .speed_px = 3, .points = {{0.1, 0.5}, {0.5, 0.1}, {0.9, 0.5}}};
  const Motion spline(params, kFrame, 1);
  ExpectAt(spline, 0, {19.5, 49.5});
  double way_px = 0, nearest_px = 1e9;
  for (double time = 0; time < 80; time += 0.25) {
    const cv::Point2d here = spline.At(time).centre, next = spline.At(time + 0.25).centre;
    way_px += cv::norm(next - here);
    nearest_px = std::min(nearest_px, cv::norm(here - cv::Point2d(99.5, 9.5)));
    if (way_px < 170) {
      EXPECT_NEAR(cv::norm(next - here), 0.75, 0.01) << time;
    }
  }
  EXPECT_LT(nearest_px, 0.4);  // half a step
  ExpectAt(spline, 1000, {179.5, 49.5});
  ExpectAt(spline, -1, {19.5, 49.5});
  // Two points are a straight line.
  const Motion straight({.path = PathKind::kSpline, .speed_px = 3, .points = {{0, 0}, {1, 0}}}, kFrame, 1);
  ExpectAt(straight, 10, {29.5, -0.5}, 1e-6);
}

TEST(Motion, ASwayComesBack) {
  const Motion sway({.path = PathKind::kSway, .direction_deg = 90, .sway_px = 8, .period_frames = 12}, kFrame,
                    1);
  ExpectAt(sway, 0, {99.5, 49.5});
  ExpectAt(sway, 3, {99.5, 57.5});
  ExpectAt(sway, 6, {99.5, 49.5});
  ExpectAt(sway, 9, {99.5, 41.5});
}

TEST(Motion, SizeAndAngleOverTime) {
  const Motion motion({.scale_rate = 1.1, .rotation_deg = 90, .rotation_rate = -9}, kFrame, 1);
  EXPECT_EQ(motion.At(0).scale, 1);
  EXPECT_NEAR(motion.At(2).scale, 1.21, 1e-12);
  EXPECT_NEAR(motion.At(10).turns, 0, 1e-12);
  EXPECT_EQ(Motion({}, kFrame, 1).At(1e6).scale, 1);
}

TEST(Motion, WhatCannotBeIsNamed) {
  EXPECT_THROW(Motion({.path = PathKind::kSpline, .points = {{0, 0}}}, kFrame, 1), std::invalid_argument);
  EXPECT_THROW(Motion({.path = PathKind::kArc, .radius_px = 0}, kFrame, 1), std::invalid_argument);
}

std::string ErrorOf(const MotionParams& params, int64_t frames) {
  try {
    Motion(params, kFrame, frames);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Motion, APathThatLeavesTheFrameIsRefusedShiftedOrAllowed) {
  MotionParams params{.start_x = 0.9, .start_y = 0.5, .speed_px = 5};  // from 179.5 on: 199.5 is the edge
  EXPECT_EQ(ErrorOf(params, 5), "");
  EXPECT_EQ(ErrorOf(params, 6),
            "leaves the scene: in frame 5 its middle is at (204.5, 49.5) px, must be within 200x100 px "
            "(off_frame \"shift\" moves the path, \"allow\" lets it go)");
  params.off_frame = OffFrame::kAllow;
  ExpectAt(Motion(params, kFrame, 10), 9, {224.5, 49.5});
  params.off_frame = OffFrame::kShift;
  ExpectAt(Motion(params, kFrame, 10), 9, {199.5, 49.5});  // by as little as keeps its last place within
  ExpectAt(Motion(params, kFrame, 10), 0, {154.5, 49.5});
  ExpectAt(Motion(params, kFrame, 5), 4, {199.5, 49.5});
  ExpectAt(Motion({.start_x = -1, .start_y = 2, .speed_px = 1, .off_frame = OffFrame::kShift}, kFrame, 11), 0,
           {-0.5, 99.5});
  EXPECT_EQ(ErrorOf(params, 42),
            "leaves the scene: its path is (205.0, 0.0) px wide and high, must be within 200x100 px");
}

TEST(Motion, KnowsWhetherItBeginsToTheLeft) {
  const auto begins_left = [](MotionParams params) {
    params.off_frame = OffFrame::kAllow;
    return Motion(params, kFrame, 9).BeginsLeftward();
  };
  for (const double degrees : {180.0, 91.0, -91.0, 269.0, -180.0})
    EXPECT_TRUE(begins_left({.direction_deg = degrees})) << degrees;
  for (const double degrees : {0.0, 89.0, 90.0, -90.0, 270.0, 360.0})
    EXPECT_FALSE(begins_left({.direction_deg = degrees})) << degrees;
  EXPECT_FALSE(begins_left({.speed_px = 0, .direction_deg = 180}));
  EXPECT_TRUE(begins_left({.path = PathKind::kSway, .direction_deg = 180}));
  EXPECT_TRUE(begins_left({.path = PathKind::kArc, .direction_deg = 180, .radius_px = -30}));
  EXPECT_TRUE(begins_left({.path = PathKind::kSpline, .points = {{0.9, 0.1}, {0.2, 0.5}}}));
  EXPECT_FALSE(begins_left({.path = PathKind::kSpline, .points = {{0.1, 0.1}, {0.2, 0.5}}}));
}

}  // namespace
}  // namespace shimmer::sim
