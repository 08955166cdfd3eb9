#include "sim/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

constexpr float kRed[] = {0.8f, 0.2f, 0.1f};
const cv::Vec3f kColour(kRed[0], kRed[1], kRed[2]);

double AreaOf(const Layer& layer) { return layer.area.empty() ? 0 : cv::sum(layer.rgba)[3]; }

// Within half a px of its boundary, all around: so says the issue; by the distances it is far nearer, and
// worst where it is hardly a pixel.
TEST(Shapes, ADiscHasItsArea) {
  for (const double radius_px : {0.8, 3.0, 10.3, 60.0})
    for (const cv::Point2d& centre : {cv::Point2d(0, 0), cv::Point2d(20.3, -7.9), cv::Point2d(0.5, 0.5)}) {
      const Layer disc =
          DrawParts(PartsOf(Shape::kDisc, 0, kColour), 2 * radius_px, {.centre = centre, .turns = 0.13});
      const double boundary_px = 2 * M_PI * radius_px;
      EXPECT_NEAR(AreaOf(disc), M_PI * radius_px * radius_px, 0.08 * boundary_px) << radius_px << centre;
      // Its middle lies where it should.
      double x = 0, y = 0;
      for (int row = 0; row < disc.area.height; ++row)
        for (int column = 0; column < disc.area.width; ++column) {
          const double share = disc.rgba.at<cv::Vec4f>(row, column)[3] / AreaOf(disc);
          x += share * (disc.area.x + column), y += share * (disc.area.y + row);
        }
      EXPECT_NEAR(x, centre.x, 0.06) << radius_px;
      EXPECT_NEAR(y, centre.y, 0.06) << radius_px;
    }
}

TEST(Shapes, AnUprightBoxCoversExactly) {
  const ShapePart box{ShapePart::Kind::kBox, {0, 0}, {0.5, 0.25}, 0, kColour};
  for (const cv::Point2d& centre : {cv::Point2d(0, 0), cv::Point2d(0.3, 0.85), cv::Point2d(-100.25, 7.5)}) {
    const Layer layer = DrawParts({box}, 20, {.centre = centre});
    // At a corner the distance says half a pixel where it may be a quarter.
    EXPECT_NEAR(AreaOf(layer), 20 * 10, 4 * 0.25 + 1e-4);
    for (const double turns : {0.25, 0.5, 1.0})
      EXPECT_NEAR(AreaOf(DrawParts({box}, 20, {.centre = centre, .turns = turns})), 200, 4 * 0.25 + 1e-4);
  }
}

TEST(Shapes, ColoursAreTimesTheirCoverage) {
  const ShapePart disc{ShapePart::Kind::kCapsule, {0, 0}, {0, 0}, 0.5, kColour};
  const Layer layer = DrawParts({disc}, 9, {.centre = {4.2, 3.1}});
  for (int y = 0; y < layer.area.height; ++y)
    for (int x = 0; x < layer.area.width; ++x) {
      const cv::Vec4f& pixel = layer.rgba.at<cv::Vec4f>(y, x);
      EXPECT_GE(pixel[3], 0);
      EXPECT_LE(pixel[3], 1);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c], kRed[c] * pixel[3], 1e-6);
    }
}

TEST(Shapes, TheAreaHoldsAllOfIt) {
  for (const Shape shape : {Shape::kBox, Shape::kDisc, Shape::kWalker})
    for (double stride = 0; stride < 1; stride += 0.1) {
      const Layer layer =
          DrawParts(PartsOf(shape, stride, kColour), 40, {.centre = {3, 5}, .scale = 1.3, .turns = stride});
      for (const int x : {0, layer.area.width - 1})
        for (int y = 0; y < layer.area.height; ++y) EXPECT_LE(layer.rgba.at<cv::Vec4f>(y, x)[3], 0.5);
      for (const int y : {0, layer.area.height - 1})
        for (int x = 0; x < layer.area.width; ++x) EXPECT_LE(layer.rgba.at<cv::Vec4f>(y, x)[3], 0.5);
      EXPECT_GT(AreaOf(layer), 200);
    }
  EXPECT_TRUE(DrawParts(PartsOf(Shape::kBox, 0, kColour), 0, {}).area.empty());
}

// A rigid object's flow is that of its pose, and nothing where it is not.
TEST(Shapes, FlowOfARigidObjectIsThatOfItsPose) {
  const auto car = PartsOf(Shape::kBox, 0, kColour);
  const Pose now{.centre = {30.2, 20.1}, .scale = 1, .turns = 0.02},
      next{.centre = {33.7, 19.4}, .scale = 1.1, .turns = 0.05};
  const Layer layer = DrawParts(car, 20, now);
  const cv::Mat flow = PartsFlow(car, now, car, next, 20, layer.area);
  int seen = 0;
  for (int y = 0; y < layer.area.height; ++y)
    for (int x = 0; x < layer.area.width; ++x) {
      const cv::Vec2f& way = flow.at<cv::Vec2f>(y, x);
      const float alpha = layer.rgba.at<cv::Vec4f>(y, x)[3];
      if (alpha < 0.5f) {
        EXPECT_TRUE(std::isnan(way[0])) << x << " " << y;
      }
      if (alpha <= 0.5f || std::isnan(way[0])) continue;
      ++seen;
      const cv::Point2d pixel(layer.area.x + x, layer.area.y + y), there = Moved(pixel, now, next);
      EXPECT_NEAR(way[0], there.x - pixel.x, 1e-4);
      EXPECT_NEAR(way[1], there.y - pixel.y, 1e-4);
    }
  EXPECT_GT(seen, 400);
}

// A foot on the ground while the body goes over it: the flow there is the foot's own.
TEST(Shapes, FlowOfAWalkerIsThatOfEachLimb) {
  const auto now = PartsOf(Shape::kWalker, 0.1, kColour), next = PartsOf(Shape::kWalker, 0.14, kColour);
  const Pose pose{.centre = {50, 60}}, next_pose{.centre = {53, 60}};
  const cv::Mat flow = PartsFlow(now, pose, next, next_pose, 100, {0, 0, 100, 120});
  for (const size_t part : {size_t{6}, size_t{7}}) {  // the near leg
    const cv::Point2d foot = pose.centre + now[part].b * 100, there = next_pose.centre + next[part].b * 100;
    const cv::Vec2f& way = flow.at<cv::Vec2f>(cvRound(foot.y), cvRound(foot.x));
    EXPECT_NEAR(way[0], there.x - foot.x, 0.15)
        << part;  // of the pixel beside, as a limb turns by 0.2 at most
    EXPECT_NEAR(way[1], there.y - foot.y, 0.15) << part;
  }
}

TEST(Shapes, AWalkerIsOneHighAndComesBackAfterAStride) {
  double top = 1, bottom = -1;
  for (double stride = 0; stride < 1; stride += 0.02)
    for (const ShapePart& part : PartsOf(Shape::kWalker, stride, kColour)) {
      top = std::min({top, part.a.y - part.radius, part.b.y - part.radius});
      bottom = std::max({bottom, part.a.y + part.radius, part.b.y + part.radius});
    }
  EXPECT_NEAR(bottom - top, 1, 0.03);
  const auto parts = PartsOf(Shape::kWalker, 0.3, kColour), later = PartsOf(Shape::kWalker, 1.3, kColour);
  for (size_t i = 0; i < parts.size(); ++i) EXPECT_NEAR(cv::norm(parts[i].b - later[i].b), 0, 1e-12);
}

// Within an area: the same pixels as of the whole.
TEST(Shapes, APartOfALayerIsAPartOfIt) {
  const auto car = PartsOf(Shape::kBox, 0, kColour);
  const Pose pose{.centre = {11.3, 7.9}, .scale = 1.1, .turns = 0.07};
  const Layer whole = DrawParts(car, 20, pose);
  for (const cv::Rect within : {cv::Rect(3, 2, 15, 9), cv::Rect(-100, -100, 105, 110), whole.area}) {
    const Layer part = DrawParts(car, 20, pose, within);
    EXPECT_EQ(part.area, whole.area & within);
    EXPECT_TRUE(SameBytes(part.rgba, whole.rgba(part.area - whole.area.tl())));
  }
  EXPECT_TRUE(DrawParts(car, 20, pose, {1000, 0, 5, 5}).area.empty());
  EXPECT_TRUE(DrawParts(car, 20, pose, {}).area.empty());
}

TEST(Shapes, MirroredHeadsTheOtherWay) {
  for (const Shape shape : {Shape::kBox, Shape::kDisc, Shape::kWalker}) {
    const auto picture_of = [](const std::vector<ShapePart>& parts) {
      const Layer layer = DrawParts(parts, 40, {.centre = {50, 50}});
      cv::Mat picture = cv::Mat::zeros(101, 101, CV_32FC4);
      layer.rgba.copyTo(picture(layer.area));
      return picture;
    };
    const auto parts = PartsOf(shape, 0.15, kColour);
    cv::Mat flipped;
    cv::flip(picture_of(Mirrored(parts)), flipped, 1);
    EXPECT_LT(cv::norm(flipped, picture_of(parts), cv::NORM_INF), 1e-5);  // but for a double's rounding
  }
}

}  // namespace
}  // namespace shimmer::sim
