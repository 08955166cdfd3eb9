#include "sim/app/colour_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace shimmer::app {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

cv::Vec3b TiltColour(float dx, float dy, double full_scale_px = 4) {
  return TiltAsColours(cv::Mat(1, 1, CV_32FC2, cv::Scalar(dx, dy)), full_scale_px).at<cv::Vec3b>(0, 0);
}

cv::Vec3b HeatColour(float sigma) {
  return SigmaAsHeat(cv::Mat(1, 1, CV_32FC1, cv::Scalar(sigma)), 1, 3).at<cv::Vec3b>(0, 0);
}

int Sum(const cv::Vec3b& colour) { return colour[0] + colour[1] + colour[2]; }

TEST(TiltAsColours, ShowsNoShiftWhite) { EXPECT_EQ(TiltColour(0, 0), cv::Vec3b(255, 255, 255)); }

TEST(TiltAsColours, ShowsDirectionAsHue) {
  EXPECT_EQ(TiltColour(4, 0), cv::Vec3b(255, 0, 0));
  EXPECT_EQ(TiltColour(-4, 0), cv::Vec3b(0, 255, 255));
  for (int degrees = 0; degrees < 360; degrees += 7) {
    const double angle = degrees * std::numbers::pi / 180;
    const auto dx = float(5 * std::cos(angle)), dy = float(5 * std::sin(angle));
    const cv::Vec3b there = TiltColour(dx, dy), back = TiltColour(-dx, -dy);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(there[c] + back[c], 255, 1) << degrees;  // complements; rounded to a level
  }
}

TEST(TiltAsColours, ShowsLengthAsSaturation) {
  EXPECT_NEAR(TiltColour(2, 0)[1], 127.5, 0.51);  // half of full scale
  EXPECT_EQ(TiltColour(2, 0, 2), TiltColour(4, 0, 4));
  EXPECT_EQ(TiltColour(400, 0), TiltColour(4, 0));
  EXPECT_EQ(TiltColour(kNan, 0), cv::Vec3b::all(kNotFiniteGrey));
  EXPECT_EQ(TiltColour(0, -kInf), cv::Vec3b::all(kNotFiniteGrey));
}

TEST(TiltAsColours, RefusesBadInput) {
  const cv::Mat tilt(2, 2, CV_32FC2, cv::Scalar::all(0));
  EXPECT_THROW(TiltAsColours(tilt, 0), std::invalid_argument);
  EXPECT_THROW(TiltAsColours(tilt, kNan), std::invalid_argument);
  EXPECT_THROW(TiltAsColours(cv::Mat(2, 2, CV_32FC1), 1), std::invalid_argument);
}

TEST(SigmaAsHeat, RisesFromEndToEnd) {
  EXPECT_LT(Sum(HeatColour(1)), 20);              // nearly black
  EXPECT_GT(Sum(HeatColour(3)), 600);             // nearly white
  EXPECT_GT(HeatColour(3)[0], HeatColour(3)[2]);  // yellow, not blue: RGB, not BGR
  EXPECT_EQ(HeatColour(-5), HeatColour(1));
  EXPECT_EQ(HeatColour(99), HeatColour(3));
  for (float sigma = 1; sigma < 2.9f; sigma += 0.1f)
    EXPECT_LT(Sum(HeatColour(sigma)), Sum(HeatColour(sigma + 0.1f)));
  EXPECT_EQ(HeatColour(kNan), cv::Vec3b::all(kNotFiniteGrey));
  EXPECT_EQ(HeatColour(kInf), cv::Vec3b::all(kNotFiniteGrey));
}

TEST(SigmaAsHeat, RefusesBadInput) {
  const cv::Mat sigma(2, 2, CV_32FC1, cv::Scalar(1));
  EXPECT_THROW(SigmaAsHeat(sigma, 1, 1), std::invalid_argument);
  EXPECT_THROW(SigmaAsHeat(sigma, 0, kNan), std::invalid_argument);
  EXPECT_THROW(SigmaAsHeat(cv::Mat(2, 2, CV_32FC3), 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::app
