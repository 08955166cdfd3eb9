#include "restore/border_fill.h"

#include <gtest/gtest.h>

#include <vector>

#include "restore/translate.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

struct Shown {
  std::vector<cv::Mat> frames;
  std::vector<FrameShift> shifts;
};

std::vector<SteadyFrame> Filled(const Shown& shown, int ahead) {
  BorderFill fill(ahead);
  std::vector<SteadyFrame> steady;
  for (size_t k = 0; k < shown.frames.size(); ++k) {
    auto frame = fill.Next(shown.frames[k], shown.shifts[k]);
    EXPECT_EQ(frame.has_value(), static_cast<int>(k) >= ahead);
    if (frame) steady.push_back(*frame);
  }
  while (auto frame = fill.Rest()) steady.push_back(*frame);
  EXPECT_EQ(steady.size(), shown.frames.size());
  return steady;
}

// Frames of one level each, 40x20 px: what a px was taken from can be read.
Shown Levels(const std::vector<cv::Point2d>& shifts) {
  Shown shown;
  for (size_t k = 0; k < shifts.size(); ++k) {
    shown.frames.emplace_back(20, 40, CV_8UC1, cv::Scalar(10.0 * static_cast<double>(k + 1)));
    shown.shifts.push_back({.px = shifts[k]});
  }
  return shown;
}

// The nearest in time that sees it, of two as near the earlier; own says what is filled.
TEST(BorderFill, TakesFromTheNearestFrame) {
  // Frames 1 and 4 do not see the right 10 columns, frame 3 the left 5.
  const Shown shown = Levels({{0, 0}, {10, 0}, {10, 0}, {-5, 0}, {10, 0}, {0, 0}});
  const auto steady = Filled(shown, 2);
  const int right[] = {10, 10, 40, 40, 40, 60}, left[] = {10, 20, 30, 30, 50, 60};
  for (size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(steady[k].frame.at<uint8_t>(7, 35), right[k]) << k;
    EXPECT_EQ(steady[k].frame.at<uint8_t>(7, 2), left[k]) << k;
    const cv::Rect own = SeenArea({40, 20}, shown.shifts[k].px);
    EXPECT_EQ(cv::countNonZero(steady[k].own), own.area());
    EXPECT_EQ(cv::countNonZero(steady[k].own(own) != 255), 0);
  }
}

TEST(BorderFill, LooksBackWithoutLimitAndAheadByItsWindow) {
  std::vector<cv::Point2d> shifts(12, {10, 0});
  shifts.front() = shifts.back() = {0, 0};
  const auto steady = Filled(Levels(shifts), 3);
  for (size_t k = 1; k < 11; ++k)  // frame 11 is nearer and within 3 from frame 8 on
    EXPECT_EQ(steady[k].frame.at<uint8_t>(7, 35), k >= 8 ? 120 : 10) << k;
}

// Frames that are not found lend nothing, and what no frame saw goes on from the frame's own edge.
TEST(BorderFill, OnlyFoundFramesLend) {
  Shown shown = Levels({{0, 6}, {0, 6}, {0, 0}});
  shown.shifts[2].match = Match::kLost;
  const auto steady = Filled(shown, 2);
  EXPECT_EQ(steady[0].frame.at<uint8_t>(18, 3), 10);
  EXPECT_EQ(steady[1].frame.at<uint8_t>(18, 3), 20);
  EXPECT_EQ(steady[1].own.at<uint8_t>(18, 3), 0);
}

// A whole scene: filled px are those of the scene at that place, and never the grey of a border.
TEST(BorderFill, ShowsTheScene) {
  const cv::Size size(96, 64);
  Shown shown;
  for (int k = 0; k < 10; ++k) {
    const cv::Point2d shift = WanderingShift(k, 15);
    shown.frames.push_back(SeenFrame({.size = size, .shift = shift}));
    shown.shifts.push_back({.px = shift});
  }
  const cv::Mat scene = SeenFrame({.size = size});
  for (const int ahead : {0, 4, 20})
    for (const SteadyFrame& steady : Filled(shown, ahead)) {
      cv::Mat error;
      cv::absdiff(steady.frame, scene, error);
      // Frame 0 sees all of it. Within 3 px of a frame's edge the kernel reaches beyond it.
      EXPECT_LT(cv::mean(error)[0], 0.002);
      EXPECT_LT(cv::norm(error, cv::NORM_INF), 0.1);
    }
}

TEST(BorderFill, RefusesBadInput) {
  EXPECT_THROW(BorderFill(-1), std::invalid_argument);
  BorderFill fill;
  fill.Next(cv::Mat::zeros(8, 8, CV_8UC3), {});
  EXPECT_THROW(fill.Next(cv::Mat::zeros(8, 9, CV_8UC3), {}), std::invalid_argument);
  EXPECT_THROW(fill.Next(cv::Mat::zeros(8, 8, CV_8UC1), {}), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
