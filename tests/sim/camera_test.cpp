#include "sim/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace shimmer::sim {
namespace {

constexpr ClipKey kKey{0, 3};
const std::vector<Shake> kRandom = {Shake::kWalk, Shake::kDrift, Shake::kVibration};

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TEST(ShakePath, BeginsAtNothingAndALongerOneBeginsAsAShorter) {
  for (const Shake shake : kRandom) {
    const CameraParams camera{.shake = shake, .amplitude_px = 3, .bound_px = 20};
    const auto path = ShakePath(camera, kKey, 50), shorter = ShakePath(camera, kKey, 7);
    EXPECT_EQ(path.front(), cv::Point2d(0, 0));
    EXPECT_EQ(std::vector(path.begin(), path.begin() + 7), shorter);
    EXPECT_NE(path, ShakePath(camera, {0, 4}, 50));
    EXPECT_NE(path[1], cv::Point2d(0, 0));
  }
  EXPECT_EQ(ShakePath({}, kKey, 3), std::vector<cv::Point2d>(3));
}

TEST(ShakePath, StaysWithinItsBound) {
  for (const Shake shake : {Shake::kWalk, Shake::kDrift})
    for (const double bound_px : {0.0, 0.7, 400.0}) {
      const CameraParams camera{
          .shake = shake, .amplitude_px = 100, .correlation_frames = 3, .bound_px = bound_px};
      double most = 0;
      for (const cv::Point2d& s : ShakePath(camera, kKey, 2000))
        most = std::max({most, std::abs(s.x), std::abs(s.y)});
      EXPECT_LE(most, bound_px);
      EXPECT_GE(most, 0.7 * bound_px) << "it should get there";
    }
}

// Steps of a walk that meets no bound: standard deviation as asked for, within 3 of its own (n = 20,000: 0.5
// %).
TEST(ShakePath, AWalkHasItsSteps) {
  const CameraParams camera{.shake = Shake::kWalk, .amplitude_px = 0.01, .bound_px = 400};
  const auto path = ShakePath(camera, kKey, 10'001);
  std::vector<double> squares, products;
  for (size_t k = 1; k < path.size(); ++k) {
    const cv::Point2d step = path[k] - path[k - 1];
    squares.push_back(step.x * step.x), squares.push_back(step.y * step.y);
    products.push_back(step.x * step.y);
  }
  EXPECT_NEAR(std::sqrt(Mean(squares)), 0.01, 0.00015);
  EXPECT_NEAR(Mean(products), 0, 0.0001 * 3 / 100);  // x and y know nothing of each other
}

// Over many clips: the difference of two places of the process has variance 2 sd^2 (1 - exp(-k / tau)).
TEST(ShakePath, ADriftHasItsVarianceAndCorrelation) {
  const CameraParams camera{
      .shake = Shake::kDrift, .amplitude_px = 2, .correlation_frames = 5, .bound_px = 400};
  for (const size_t k : {1, 5, 60}) {
    std::vector<double> squares;
    for (uint64_t clip = 0; clip < 10'000; ++clip) {
      const cv::Point2d s = ShakePath(camera, {7, clip}, 61)[k];
      squares.push_back(s.x * s.x), squares.push_back(s.y * s.y);
    }
    const double expected = 2 * 4 * (1 - std::exp(-static_cast<double>(k) / 5));
    EXPECT_NEAR(Mean(squares), expected, 3 * expected * std::sqrt(2.0 / 20'000)) << k;
  }
}

TEST(ShakePath, AVibrationIsASineOfItsFrequency) {
  const CameraParams camera{
      .shake = Shake::kVibration, .amplitude_px = 5, .frequency = 0.125, .direction_deg = 30};
  const auto path = ShakePath(camera, kKey, 17);
  EXPECT_NEAR(cv::norm(path[8]), 0, 1e-12) << "a whole period";
  double most = 0;
  for (size_t k = 0; k < path.size(); ++k) {
    EXPECT_NEAR(path[k].y * std::cos(M_PI / 6), path[k].x * std::sin(M_PI / 6), 1e-12) << "along 30 degrees";
    // Half a period apart it is as far on the other side of its middle.
    if (k >= 4) {
      EXPECT_NEAR(cv::norm(path[k] + path[k - 4] - (path[4] + path[0])), 0, 1e-12);
    }
    for (const cv::Point2d& other : path) most = std::max(most, cv::norm(path[k] - other));
  }
  EXPECT_LE(most, 10 + 1e-12);
  EXPECT_GT(most, 9.2) << "samples an eighth of a period apart come within 8 % of both ends";
}

TEST(ShakePath, AListIsCountedFromItsFirst) {
  const CameraParams camera{.shake = Shake::kList, .shifts = {{1, 2}, {1.5, -3}, {0, 2}}};
  EXPECT_EQ(ShakePath(camera, kKey, 2), (std::vector<cv::Point2d>{{0, 0}, {0.5, -5}}));
  EXPECT_EQ(ShakePath(camera, kKey, 3).back(), cv::Point2d(-1, 0));
}

// So much must lie around the crop, of all clips alike: no clip goes further, and one goes nearly as far.
TEST(ShakeReach, HoldsEveryPath) {
  const std::vector<cv::Point2d> shifts = {{3, 1}, {3.5, -1.25}, {-4, 1}};
  for (const CameraParams& camera :
       {CameraParams{.shake = Shake::kWalk, .amplitude_px = 5, .bound_px = 12},
        CameraParams{.shake = Shake::kDrift, .amplitude_px = 20, .bound_px = 12},
        CameraParams{.shake = Shake::kVibration, .amplitude_px = 7, .frequency = 0.13, .direction_deg = 20},
        CameraParams{.shake = Shake::kList, .shifts = shifts}}) {
    const cv::Size reach = ShakeReach(camera);
    cv::Point2d most;
    for (uint64_t clip = 0; clip < 50; ++clip)
      for (const cv::Point2d& s : ShakePath(camera, {0, clip}, camera.shifts.empty() ? 60 : 3))
        most = {std::max(most.x, std::abs(s.x)), std::max(most.y, std::abs(s.y))};
    EXPECT_LE(most.x, reach.width);
    EXPECT_LE(most.y, reach.height);
    EXPECT_GT(most.x, reach.width - 1.2);
    EXPECT_GT(most.y, reach.height - 1.2);
  }
  EXPECT_EQ(ShakeReach({.shake = Shake::kVibration, .amplitude_px = 2}), cv::Size(0, 4)) << "along y alone";
  EXPECT_EQ(ShakeReach({}), cv::Size());
  EXPECT_EQ(ShakeReach({.shake = Shake::kWalk, .amplitude_px = 0}), cv::Size());
}

TEST(ShakePath, WhatCannotBeIsNamed) {
  const auto error = [](const CameraParams& camera, int64_t frames) -> std::string {
    try {
      ShakePath(camera, kKey, frames);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(error({.shake = Shake::kList, .shifts = {{0, 0}}}, 2),
            "camera.shifts: has 1 shifts, must have one for each of the 2 frames");
}

}  // namespace
}  // namespace shimmer::sim
