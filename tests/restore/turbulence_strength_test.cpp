#include "restore/turbulence_strength.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/restore/frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

const cv::Size kSize(170, 120);
constexpr uint32_t kFrames = 24;

// Of frames with air of their own each: the view's frame number is set.
TurbulenceStrength Found(View view, int type = CV_32FC1, uint32_t frames = kFrames) {
  StrengthEstimate estimate;
  for (uint32_t k = 0; k < frames; ++k) {
    view.frame = k;
    cv::Mat frame;
    SeenFrame(view).convertTo(frame, type, WhiteOf(CV_MAT_DEPTH(type)));
    estimate.Add(frame);
  }
  return estimate.Result();
}

// The proportional value is the variance of the tilt along an axis. 24 frames of 12 waves, of which
// several lengths are in the frame, tell it to some 5 %; what is left of the gradients' mean is below 3 %.
TEST(StrengthEstimate, IsTheVarianceOfTheTilt) {
  for (const double tilt_px : {0.25, 0.5, 1.0, 2.0, 3.0}) {
    const TurbulenceStrength found = Found({.size = kSize, .tilt_rms_px = tilt_px});
    EXPECT_NEAR(std::sqrt(found.tilt_variance_px2) / tilt_px, 1, 0.1) << tilt_px;
    EXPECT_GT(found.texture, 0.9);
  }
}

// In px of the frame, where that is reduced by 2 first.
TEST(StrengthEstimate, CountsPxOfTheFrame) {
  const TurbulenceStrength found = Found({.size = {530, 516}, .tilt_rms_px = 1}, CV_32FC1, 8);
  EXPECT_NEAR(std::sqrt(found.tilt_variance_px2), 1, 0.15);  // 8 frames
  EXPECT_EQ(found.square_px, 32);
  EXPECT_EQ(found.map.size(), cv::Size(17, 17));
}

TEST(StrengthEstimate, IsZeroWithoutTurbulence) {
  EXPECT_EQ(StrengthEstimate().Result().tilt_variance_px2, 0);
  EXPECT_LT(Found({.size = kSize}).tilt_variance_px2, 1e-8);
  StrengthEstimate one;
  one.Add(SeenFrame({.size = kSize, .tilt_rms_px = 1}));
  EXPECT_EQ(one.Result().tilt_variance_px2, 0);
  StrengthEstimate black;
  for (int k = 0; k < 5; ++k) black.Add(cv::Mat::zeros(kSize, CV_8UC3));
  EXPECT_EQ(black.Result().tilt_variance_px2, 0);
  EXPECT_EQ(black.Result().texture, 0);
}

// Noise of 5 levels alone would be a tilt of 0.2 px and more: half of the scene is flat, and tells it.
TEST(StrengthEstimate, NoiseIsNoTilt) {
  for (const double tilt_px : {0.0, 0.5}) {
    StrengthEstimate estimate;
    for (uint32_t k = 0; k < kFrames; ++k) {
      cv::Mat frame = SeenFrame({.size = kSize, .tilt_rms_px = tilt_px, .frame = k});
      frame.colRange(0, kSize.width / 2) = 0.5;
      cv::Mat noise(kSize, CV_32FC1);
      cv::RNG random(k + 1);
      random.fill(noise, cv::RNG::NORMAL, 0, 5 / 255.0);
      estimate.Add(frame + noise);
    }
    const TurbulenceStrength found = estimate.Result();
    EXPECT_NEAR(std::sqrt(found.tilt_variance_px2), tilt_px, 0.07);
    // Smoothing by sigma = 1 leaves 1 / (4 pi) of its variance.
    EXPECT_NEAR(found.noise_levels, 5 / std::sqrt(4 * M_PI), 0.2);
    EXPECT_TRUE(std::isnan(found.map.at<float>(3, 2)));  // nothing to be seen there
    EXPECT_NEAR(static_cast<double>(found.map.at<float>(3, 8)), tilt_px * tilt_px, 0.2);
  }
}

// Stronger air on the right: the map says so.
TEST(StrengthEstimate, MapsWhereTheAirIsStronger) {
  StrengthEstimate estimate;
  for (uint32_t k = 0; k < kFrames; ++k) {
    cv::Mat frame = SeenFrame({.size = kSize, .tilt_rms_px = 0.3, .frame = k});
    SeenFrame({.size = kSize, .tilt_rms_px = 1.2, .frame = k})
        .colRange(kSize.width / 2, kSize.width)
        .copyTo(frame.colRange(kSize.width / 2, kSize.width));
    estimate.Add(frame);
  }
  const cv::Mat map = estimate.Result().map;
  EXPECT_NEAR(std::sqrt(cv::mean(map.colRange(0, 5))[0]), 0.3, 0.06);
  EXPECT_NEAR(std::sqrt(cv::mean(map.colRange(6, 10))[0]), 1.2, 0.24);
}

// Something that crosses the frame: left out by its mask. Without one it would be taken for air.
TEST(StrengthEstimate, MasksLeaveOutWhatMoves) {
  StrengthEstimate masked, plain;
  for (uint32_t k = 0; k < kFrames; ++k) {
    const cv::Rect box(6 * static_cast<int>(k), 40, 40, 40);
    const cv::Mat frame = SeenFrame({.size = kSize, .tilt_rms_px = 0.5, .frame = k, .box = box});
    cv::Mat moving = cv::Mat::zeros(kSize, CV_8UC1);
    moving(box & cv::Rect({0, 0}, kSize)) = 255;
    masked.Add(frame, moving);
    plain.Add(frame);
  }
  EXPECT_NEAR(std::sqrt(masked.Result().tilt_variance_px2), 0.5, 0.05);
  EXPECT_GT(cv::mean(plain.Result().map.row(3))[0], 4 * cv::mean(masked.Result().map.row(3))[0]);
}

TEST(StrengthEstimate, IsTheSameForEveryKindOfFrame) {
  const double of_floats = Found({.size = kSize, .tilt_rms_px = 1}).tilt_variance_px2;
  for (const int type : {CV_8UC1, CV_16UC1})
    EXPECT_NEAR(Found({.size = kSize, .tilt_rms_px = 1}, type).tilt_variance_px2 / of_floats, 1, 0.01);
}

TEST(StrengthEstimate, RefusesBadInput) {
  StrengthEstimate estimate;
  EXPECT_THROW(estimate.Add({}), std::invalid_argument);
  EXPECT_THROW(estimate.Add(cv::Mat::zeros(15, 99, CV_8UC1)), std::invalid_argument);
  EXPECT_THROW(estimate.Add(cv::Mat::zeros(16, 16, CV_8UC1), cv::Mat::zeros(16, 17, CV_8UC1)),
               std::invalid_argument);
  estimate.Add(cv::Mat::zeros(16, 16, CV_8UC1));
  EXPECT_THROW(estimate.Add(cv::Mat::zeros(16, 16, CV_8UC3)), std::invalid_argument);
  EXPECT_THROW(estimate.Add(cv::Mat::zeros(17, 16, CV_8UC1)), std::invalid_argument);
}

// The worked case of a 0.1 m aperture over 1 km, px of 3 urad, a point source in air of 1e-14: the plane's
// tilt along an axis is 4.956 urad = 1.652 px (0.1819 (lambda / D)^2 (D / r0)^(5/3), r0 = 0.038538 m).
TEST(Cn2, IsThatOfTheWorkedCase) {
  const Optics optics{.pixel_rad = 3e-6, .aperture_m = 0.1, .distance_m = 1000};
  EXPECT_NEAR(Cn2Of(1.652 * 1.652, optics) / 1e-14, 1, 1e-3);
  const double lambda = 525e-9, r0 = 0.038538,
               variance = 0.1819 * std::pow(lambda / 0.1, 2) * std::pow(0.1 / r0, 5 / 3.0);
  EXPECT_NEAR(Cn2Of(variance / 9e-12, optics) / 1e-14, 1, 1e-3);
}

TEST(Cn2, FollowsTheOptics) {
  const Optics optics{.pixel_rad = 3e-6, .aperture_m = 0.1, .distance_m = 1000};
  const double cn2 = Cn2Of(1, optics);
  const auto ratio = [&](auto change) {
    Optics other = optics;
    change(other);
    return Cn2Of(1, other) / cn2;
  };
  EXPECT_DOUBLE_EQ(Cn2Of(7, optics) / cn2, 7);
  EXPECT_DOUBLE_EQ(ratio([](Optics& o) { o.pixel_rad *= 2; }), 4);
  EXPECT_DOUBLE_EQ(ratio([](Optics& o) { o.aperture_m *= 8; }), 2);
  EXPECT_DOUBLE_EQ(ratio([](Optics& o) { o.distance_m *= 2; }), 0.5);
  EXPECT_DOUBLE_EQ(ratio([](Optics& o) { o.tilt = Tilt::kGrad; }), 3.041 / 2.838);
  EXPECT_DOUBLE_EQ(ratio([](Optics& o) { o.tilt = Tilt::kEdge; }), 3.041 / 2.914);
  EXPECT_DOUBLE_EQ(ratio([](Optics& o) { o.point_source = false; }), 3 / 8.0);
  EXPECT_THROW(Cn2Of(1, {}), std::invalid_argument);
  EXPECT_THROW(Cn2Of(1, {.pixel_rad = 1e-6, .aperture_m = NAN, .distance_m = 1}), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
