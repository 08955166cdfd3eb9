#include "sim/moving_object.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shimmer::sim {
namespace {

const cv::Size kFrame{200, 100};
const cv::Vec3f kColour(0.8f, 0.2f, 0.1f);

cv::Point2d MiddleOf(const Layer& layer) {
  cv::Point2d sum;
  double all = 0;
  for (int y = 0; y < layer.area.height; ++y)
    for (int x = 0; x < layer.area.width; ++x) {
      const double alpha = layer.rgba.at<cv::Vec4f>(y, x)[3];
      sum += cv::Point2d(layer.area.x + x, layer.area.y + y) * alpha;
      all += alpha;
    }
  return sum / all;
}

TEST(MovingObject, IsWhereItsPathIsInEachFrame) {
  const MovingObject disc(DrawnLook{Shape::kDisc, kColour}, {.speed_px = 1.75, .direction_deg = 30}, kFrame,
                          8, 20, 0);
  for (const int64_t k : {0, 1, 7}) {
    const cv::Point2d expected =
        cv::Point2d(99.5, 49.5) + cv::Point2d(std::cos(M_PI / 6), 0.5) * (1.75 * static_cast<double>(k));
    EXPECT_LT(cv::norm(MiddleOf(disc.At(k)) - expected), 0.03) << k;
  }
}

// A disc of 20 px that goes 8 px while the shutter is open: what covers a place is the share of the time that
// it is there.
TEST(MovingObject, MotionBlurIsTheMeanOverTheShutter) {
  const MotionParams motion{.speed_px = 16};
  const MovingObject still(DrawnLook{Shape::kDisc, kColour}, motion, kFrame, 3, 20, 0),
      moving(DrawnLook{Shape::kDisc, kColour}, motion, kFrame, 3, 20, 0.5);
  const Layer sharp = still.At(2), blurred = moving.At(2);
  EXPECT_LT(cv::norm(MiddleOf(sharp) - MiddleOf(blurred)), 0.01);
  EXPECT_NEAR(cv::sum(blurred.rgba)[3], cv::sum(sharp.rgba)[3], 0.5);
  // Along its middle row: from 99.5 + 32 - 10 - 4 on, rising over 8 px.
  const auto alpha_at = [&](double x) {
    return blurred.rgba.at<cv::Vec4f>(49 - blurred.area.y, cvRound(x) - blurred.area.x)[3];
  };
  EXPECT_NEAR(alpha_at(131.5 - 10), 0.5, 0.07);
  EXPECT_NEAR(alpha_at(131.5 - 12), 0.25, 0.07);
  EXPECT_NEAR(alpha_at(131.5 + 12), 0.25, 0.07);
  EXPECT_NEAR(alpha_at(131.5), 1, 1e-5);
}

TEST(MovingObject, ACutoutIsThatOfItsFrame) {
  const auto of_value = [](float value) {
    return std::make_shared<const Cutout>(cv::Mat(10, 10, CV_32FC4, cv::Scalar(value, value, value, 1)));
  };
  const MovingObject still(StillLook(of_value(0.5f)), {.speed_px = 3}, kFrame, 5, 10, 0);
  const MovingObject video(VideoLook([&](int64_t k) { return of_value(0.1f * static_cast<float>(k)); }),
                           {.speed_px = 3}, kFrame, 5, 10, 0);
  for (const int64_t k : {1, 4})
    for (const auto& [object, value] :
         {std::pair(&still, 0.5), std::pair(&video, 0.1 * static_cast<double>(k))}) {
      const Layer layer = object->At(k);
      const cv::Point middle = cv::Point(100 + 3 * static_cast<int>(k), 50) - layer.area.tl();
      EXPECT_NEAR(layer.rgba.at<cv::Vec4f>(middle)[0], value, 1e-5) << k;
    }
}

// What is seen at a pixel is seen, a frame later, where the flow says.
TEST(MovingObject, FlowLeadsToTheSamePlace) {
  const auto blob = std::make_shared<const Cutout>(cv::Mat(20, 30, CV_32FC4, cv::Scalar::all(1)));
  for (const Look& look : {Look(DrawnLook{Shape::kBox, kColour}), Look(StillLook(blob))}) {
    const MovingObject object(look, {.speed_px = 2.5, .scale_rate = 1.02, .rotation_rate = 3}, kFrame, 5, 30,
                              0.3);
    const cv::Mat flow = object.FlowAt(3, {{0, 0}, kFrame});
    const Motion motion({.speed_px = 2.5, .scale_rate = 1.02, .rotation_rate = 3}, kFrame, 5);
    int known = 0;
    for (int y = 0; y < kFrame.height; ++y)
      for (int x = 0; x < kFrame.width; ++x) {
        const cv::Vec2f& way = flow.at<cv::Vec2f>(y, x);
        if (std::isnan(way[0])) continue;
        ++known;
        const cv::Point2d there = Moved(cv::Point2d(x, y), motion.At(3), motion.At(4));
        EXPECT_NEAR(way[0], there.x - x, 1e-4);
        EXPECT_NEAR(way[1], there.y - y, 1e-4);
      }
    EXPECT_GT(known, 600);
  }
}

}  // namespace
}  // namespace shimmer::sim
