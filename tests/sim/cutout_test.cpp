#include "sim/cutout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

cv::Mat RandomCutout(cv::Size size) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0, 1);
  cv::Mat rgba(size, CV_32FC4);
  for (auto pixel = rgba.begin<cv::Vec4f>(); pixel != rgba.end<cv::Vec4f>(); ++pixel) {
    const float alpha = unit(random);
    *pixel = {alpha * unit(random), alpha * unit(random), alpha * unit(random), alpha};
  }
  return rgba;
}

// A round blob whose alpha falls softly, of radius 1 at a third of the side.
cv::Mat Blob(int side) {
  cv::Mat rgba(side, side, CV_32FC4);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double r = std::hypot(x - (side - 1) / 2.0, y - (side - 1) / 2.0) / (side / 3.0);
      const auto alpha = static_cast<float>(std::exp(-2 * r * r));
      rgba.at<cv::Vec4f>(y, x) = {alpha, 0.5f * alpha, 0, alpha};
    }
  return rgba;
}

cv::Vec4f At(const Layer& layer, int x, int y) {
  return layer.area.contains({x, y}) ? layer.rgba.at<cv::Vec4f>(y - layer.area.y, x - layer.area.x)
                                     : cv::Vec4f();
}

TEST(Cutout, AtItsSizeAndAWholePlaceItIsCopied) {
  for (const cv::Size& size : {cv::Size(7, 5), cv::Size(8, 6), cv::Size(1, 1)}) {
    const cv::Mat rgba = RandomCutout(size);
    const cv::Point2d middle((size.width - 1) / 2.0, (size.height - 1) / 2.0);
    const Layer layer = Cutout(rgba).Draw(size.height, {.centre = cv::Point2d(30, -12) + middle});
    for (int y = -3; y < size.height + 3; ++y)
      for (int x = -3; x < size.width + 3; ++x) {
        const bool inside = cv::Rect({0, 0}, size).contains({x, y});
        const cv::Vec4f expected = inside ? rgba.at<cv::Vec4f>(y, x) : cv::Vec4f();
        for (int c = 0; c < 4; ++c)
          EXPECT_NEAR(At(layer, 30 + x, y - 12)[c], expected[c], 1e-6) << x << " " << y;
      }
  }
}

TEST(Cutout, AQuarterTurnMovesSamples) {
  const cv::Mat rgba = RandomCutout({5, 5});
  const Layer layer = Cutout(rgba).Draw(5, {.centre = {2, 2}, .turns = 0.25});
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x)  // clockwise: what was above is on the right
      EXPECT_NEAR(At(layer, x, y)[3], rgba.at<cv::Vec4f>(4 - x, y)[3], 1e-5);
}

// A smooth picture at half a pixel, turned, larger and smaller: as its formula says.
TEST(Cutout, IsTheSamePictureAtAnyPose) {
  constexpr int kSide = 90;
  const Cutout blob(Blob(kSide));
  for (const double scale : {1.0, 1.7, 0.6, 0.21, 0.05})
    for (const double turns : {0.0, 0.11}) {
      const cv::Point2d centre(10.5, -3.3);
      const Layer layer = blob.Draw(kSide, {.centre = centre, .scale = scale, .turns = turns});
      double worst = 0, area = 0;
      for (int y = layer.area.y; y < layer.area.br().y; ++y)
        for (int x = layer.area.x; x < layer.area.br().x; ++x) {
          const double r = std::hypot(x - centre.x, y - centre.y) / (kSide * scale / 3.0);
          area += At(layer, x, y)[3];
          if (r < 1.2) worst = std::max(worst, std::abs(At(layer, x, y)[3] - std::exp(-2 * r * r)));
        }
      // Halved pictures are means, which are a little lower at the top: by 4 / (3 r^2) of it for a radius of
      // r samples.
      EXPECT_LT(worst, scale >= 0.5 ? 0.002 : scale > 0.1 ? 0.02 : 0.2) << scale << " " << turns;
      const double whole = cv::sum(Blob(kSide))[3] * scale * scale;
      EXPECT_NEAR(area, whole, 0.01 * whole + 0.02) << scale << " " << turns;
    }
}

TEST(Cutout, StaysWithinItsAlpha) {
  const Layer layer = Cutout(RandomCutout({9, 9})).Draw(13, {.centre = {0.3, 0.4}, .turns = 0.07});
  for (int y = 0; y < layer.area.height; ++y)
    for (int x = 0; x < layer.area.width; ++x) {
      const cv::Vec4f& pixel = layer.rgba.at<cv::Vec4f>(y, x);
      EXPECT_LE(pixel[3], 1);
      for (int c = 0; c < 3; ++c) EXPECT_TRUE(pixel[c] >= 0 && pixel[c] <= pixel[3]);
    }
}

TEST(Cutout, WhatIsNoCutout) {
  EXPECT_THROW(Cutout(cv::Mat()), std::invalid_argument);
  EXPECT_THROW(Cutout(cv::Mat(2, 2, CV_32FC3)), std::invalid_argument);
  EXPECT_TRUE(Cutout(RandomCutout({3, 3})).Draw(0, {}).area.empty());
}

TEST(Cutout, APartOfALayerIsAPartOfIt) {
  const Cutout cutout(RandomCutout({9, 6}));
  const Pose pose{.centre = {4.3, 5.4}, .turns = 0.07};
  const Layer whole = cutout.Draw(13, pose);
  for (const cv::Rect within : {cv::Rect(3, 2, 5, 4), cv::Rect(-100, -100, 106, 110), whole.area}) {
    const Layer part = cutout.Draw(13, pose, within);
    EXPECT_EQ(part.area, whole.area & within);
    EXPECT_TRUE(SameBytes(part.rgba, whole.rgba(part.area - whole.area.tl())));
  }
  EXPECT_TRUE(cutout.Draw(13, pose, {500, 0, 9, 9}).area.empty());
}

}  // namespace
}  // namespace shimmer::sim
