// Drawn scenes measured: the star and the stripes are what sim/drawn/drawn.h says, and so is what scenes are
// made of.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "sim/drawn/drawn.h"

namespace shimmer::sim {
namespace {

cv::Mat_<float> GreyOf(const cv::Mat& rgb) {
  cv::Mat grey;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

float Sample(const cv::Mat_<float>& image, double x, double y) {  // bilinear, inside the image
  const int x0 = cvFloor(x), y0 = cvFloor(y);
  const float u = float(x - x0), v = float(y - y0);
  const int x1 = std::min(x0 + 1, image.cols - 1), y1 = std::min(y0 + 1, image.rows - 1);
  return (1 - v) * ((1 - u) * image(y0, x0) + u * image(y0, x1)) +
         v * ((1 - u) * image(y1, x0) + u * image(y1, x1));
}

// --- the star

TEST(Star, LooksTheSameTurnedByQuarters) {
  // 36 spokes are 9 a quarter. 1e-4: what 1e-10 turns, the error of AngleTurns, make at most of an edge, and
  // float.
  const cv::Mat star = DrawScene(DrawnScene::kStar, {201, 201}, 11, 1, 5);
  cv::Mat turned = star.clone();
  for (int quarter = 1; quarter < 4; ++quarter) {
    cv::rotate(turned, turned, cv::ROTATE_90_CLOCKWISE);
    EXPECT_LT(cv::norm(star, turned, cv::NORM_INF), 1e-4) << quarter;
  }
}

// Light along a circle around the star's centre.
std::vector<float> Circle(const cv::Mat_<float>& star, double radius_px) {
  std::vector<float> light;
  const int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const double angle = 2 * std::numbers::pi * i / steps;
    light.push_back(Sample(star, (star.cols - 1) / 2.0 + radius_px * std::cos(angle),
                           (star.rows - 1) / 2.0 + radius_px * std::sin(angle)));
  }
  return light;
}

int Crossings(const std::vector<float>& light, float middle) {
  int count = 0;
  for (size_t i = 0; i < light.size(); ++i)
    count += (light[i] > middle) != (light[(i + 1) % light.size()] > middle);
  return count;
}

TEST(Star, HasItsSpokes) {
  const cv::Size size(401, 301);
  const cv::Mat_<float> star = GreyOf(DrawScene(DrawnScene::kStar, size, 0, 1, 2));
  for (const double share : {0.5, 0.98, 1.1})  // off the rings; the last is outside
    EXPECT_EQ(Crossings(Circle(star, share * StarRadius(size, 1)), 0.5f), 2 * kStarSpokes) << share;
}

TEST(Star, FadesToGreyWhereThePixelGridEnds) {
  const cv::Size size(401, 401);
  const cv::Mat_<float> star = GreyOf(DrawScene(DrawnScene::kStar, size, 0, 1, 2));
  const auto contrast_at_period = [&](double period_px) {
    const std::vector<float> light = Circle(star, period_px * kStarSpokes / (2 * std::numbers::pi));
    const auto [low, high] = std::minmax_element(light.begin(), light.end());
    return *high - *low;
  };
  EXPECT_LT(contrast_at_period(1.8),
            0.01);  // below 2 px and away from it by more than a pixel's width of radius
  EXPECT_GT(contrast_at_period(3.4), 0.2);
  EXPECT_GT(contrast_at_period(12), 0.8);
}

TEST(Star, GrowsWithScale) { EXPECT_DOUBLE_EQ(StarRadius({300, 200}, 2), 2 * StarRadius({300, 200}, 1)); }

// --- the stripes

// Period along the panel's direction, from the places where the light crosses its middle. Looks at the
// panel's upper part: the label is below. 0 if there are fewer than three crossings.
double MeasuredPeriod(const cv::Mat_<float>& image, const StripePanel& panel) {
  const cv::Rect_<double> part(panel.area.x, panel.area.y, panel.area.width - 1, 0.7 * panel.area.height - 1);
  double low, high;
  cv::minMaxLoc(image(panel.area), &low, &high);
  const cv::Point2d centre = (part.tl() + part.br()) / 2;
  std::vector<double> crossings;
  constexpr double kStep = 0.01;  // px
  const auto light = [&](double s) {
    const cv::Point2d at = centre + s * panel.direction;
    return part.contains(at) ? Sample(image, at.x, at.y) : std::nanf("");
  };
  const double reach = panel.area.width + panel.area.height;
  for (double s = -reach; s < reach; s += kStep) {
    const float here = light(s), next = light(s + kStep), middle = float(low + high) / 2;
    if (std::isfinite(here) && std::isfinite(next) && (here > middle) != (next > middle))
      crossings.push_back(s);
  }
  // Over whole waves, from a crossing to the last one in the same direction: no error if the middle is a
  // little off.
  if (crossings.size() < 3) return 0;
  const size_t waves = (crossings.size() - 1) / 2;
  return (crossings[2 * waves] - crossings[0]) / double(waves);
}

class StripesAtScale : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Drawn, StripesAtScale, testing::Values(1.0, 1.5, 2.0));

TEST_P(StripesAtScale, HaveTheirPeriod) {
  int measured = 0;
  for (const cv::Size size : {cv::Size(256, 256), cv::Size(640, 360), cv::Size(333, 127)}) {
    const cv::Mat_<float> image = GreyOf(DrawScene(DrawnScene::kStripes, size, 0, GetParam(), 4));
    for (const StripePanel& panel : StripePanels(size, GetParam())) {
      const double period_px = MeasuredPeriod(image, panel);
      if (period_px == 0) continue;  // less than a wave and a half in sight
      // A crossing between pixels is read linearly, so each of the two ends may be off by a tenth of a pixel.
      EXPECT_NEAR(period_px, panel.period_px, 0.2)
          << size << panel.area << (panel.square ? " square" : " sine");
      ++measured;
    }
  }
  EXPECT_GE(measured, 25);  // of 9 + 15 + 21
}

TEST(Stripes, DoubleTheirPeriodWithScale) {
  const auto once = StripePanels({256, 200}, 1), twice = StripePanels({256, 200}, 2);
  ASSERT_EQ(once.size(), twice.size());
  for (size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].area, twice[i].area);
    EXPECT_DOUBLE_EQ(2 * once[i].period_px, twice[i].period_px);
  }
}

TEST(Stripes, CoverTheCropWithAllKinds) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(1, 2000), cv::Size(64, 64), cv::Size(1920, 1080)}) {
    int covered = 0, squares = 0, slanted = 0;
    const auto panels = StripePanels(size, 1);
    for (const StripePanel& panel : panels) {
      EXPECT_EQ(panel.area & cv::Rect({}, size), panel.area);
      EXPECT_GT(panel.area.area(), 0);
      EXPECT_NEAR(cv::norm(panel.direction), 1, 1e-9);
      covered += panel.area.area();
      squares += panel.square;
      slanted += std::abs(panel.direction.x * panel.direction.y) > 0.1;
    }
    EXPECT_GE(covered, 0.9 * size.area());
    if (panels.size() >= 9) {
      EXPECT_GE(squares, 4);
      EXPECT_GE(slanted, 3);
    }
  }
}

}  // namespace
}  // namespace shimmer::sim
