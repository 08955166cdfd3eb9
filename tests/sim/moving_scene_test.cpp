#include "sim/moving_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/clip.h"
#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

const cv::Size kSize{160, 90};
const cv::Vec3f kColour(0.9f, 0.3f, 0.1f);

ClipPlan Plan() { return PlanClip({.objects = 1}, {.size = kSize, .frames = 20}, {}); }

PlacedObject Disc(double x, double y, double speed_px, double height_px, double distance = 1,
                  double shutter = 0) {
  return {MovingObject(DrawnLook{Shape::kDisc, kColour},
                       {.start_x = x,
                        .start_y = y,
                        .speed_px = speed_px,
                        .direction_deg = 20,
                        .off_frame = OffFrame::kAllow},
                       kSize, 20, height_px, shutter),
          distance};
}

// Its area is known exactly, and so is what each pixel that its edge does not cross shows.
TEST(MovingScene, TheMaskOfADiscHasItsArea) {
  for (const double radius_px : {0.8, 3.3, 12.0, 31.7})
    for (const int64_t k : {0, 3}) {
      const MovingScene scene({Disc(0.47, 0.51, 0.37, 2 * radius_px)}, Plan());
      const cv::Mat mask = scene.At(k).Mask();
      const cv::Point2d middle =
          cv::Point2d(0.47 * 160 - 0.5, 0.51 * 90 - 0.5) +
          cv::Point2d(std::cos(M_PI / 9), std::sin(M_PI / 9)) * (0.37 * static_cast<double>(k));
      const double area = cv::sum(mask)[0], exact = M_PI * radius_px * radius_px;
      EXPECT_NEAR(area, exact, (radius_px < 1 ? 0.06 : 0.03) * 2 * M_PI * radius_px)
          << "0.03 px of its boundary";
      for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x) {
          const double beyond_px = cv::norm(cv::Point2d(x, y) - middle) - radius_px;
          if (beyond_px >= 0.5) {
            EXPECT_EQ(mask.at<float>(y, x), 0) << x << " " << y;
          }
          if (beyond_px <= -0.5 && radius_px > 1) {
            EXPECT_EQ(mask.at<float>(y, x), 1) << x << " " << y;
          }
        }
    }
}

TEST(MovingScene, FlowIsThatOfTheNearestAndNothingElsewhere) {
  const MovingScene scene({Disc(0.5, 0.5, 2, 40), Disc(0.5, 0.5, 5, 20)}, Plan());
  const MovingScene::Frame frame = scene.At(0);
  const cv::Mat flow = frame.Flow(), mask = frame.Mask();
  EXPECT_EQ(flow.at<cv::Vec2f>(2, 2), cv::Vec2f(0, 0));
  const cv::Point2d along(std::cos(M_PI / 9), std::sin(M_PI / 9));
  EXPECT_NEAR(flow.at<cv::Vec2f>(45, 80)[0], 5 * along.x, 1e-4);  // the smaller one lies in front
  EXPECT_NEAR(flow.at<cv::Vec2f>(45, 80)[1], 5 * along.y, 1e-4);
  EXPECT_NEAR(flow.at<cv::Vec2f>(45, 65)[0], 2 * along.x, 1e-4);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      EXPECT_EQ(flow.at<cv::Vec2f>(y, x) != cv::Vec2f(0, 0), mask.at<float>(y, x) >= 0.5f) << x << " " << y;
}

// What one frame leaves behind is not seen in the next: each is what it would be alone.
TEST(ComposedFrames, AreThoseThatAreComposedAlone) {
  for (const Colour colour : {Colour::kStored, Colour::kLinear})
    for (const int depth : {CV_8U, CV_32F})
      for (const int channels : {1, 3}) {
        Scene scene{.colour = colour, .camera = {.shake = Shake::kWalk, .bound_px = 9}, .objects = 2};
        const ClipPlan plan = PlanClip(scene, {.size = kSize, .frames = 6}, {});
        const ClipRenderer renderer(scene, plan, {0, 2});
        cv::Mat background;
        SinesPicture(kSize, plan.AroundPx(), channels).convertTo(background, depth, depth == CV_8U ? 255 : 1);
        background.colRange(0, 140).setTo(cv::Scalar::all(0));  // constant, but for what moves over it
        const cv::Mat before = background.clone();
        const MovingScene moving({Disc(0.1, 0.4, 7, 30, 1, 0.5), Disc(0.3, 0.6, 4, 11)}, plan);
        const cv::Point origin(-plan.AroundPx(), -plan.AroundPx());
        ComposedFrames frames(background, origin, plan);
        for (const int64_t k : {0, 1, 5, 2}) {
          const FrameView view{.shake_px = ShakePath(scene.camera, {0, 2}, 6)[static_cast<size_t>(k)]};
          RenderedFrame together, alone;
          renderer.Render(k, frames.With(moving.At(k)), false, together, view);
          cv::Mat samples = background.clone();
          moving.At(k).Over(samples, origin);
          renderer.Render(k, renderer.Prepare(samples), false, alone, view);
          EXPECT_TRUE(SameBytes(together.turb, alone.turb)) << k << " " << depth << " " << channels;
        }
        EXPECT_TRUE(SameBytes(background, before));
      }
}

// An object at distance 0 is seen as it is; the truth says so.
TEST(MovingScene, ItsDistanceScalesTheTurbulenceWhereItIsSeen) {
  Scene scene{.objects = 1, .own_distances = true};
  const ClipPlan plan = PlanClip(scene, {.size = kSize, .frames = 1}, {});
  const ClipRenderer renderer(scene, plan, {0, 1});
  const int border_px = renderer.fields().border_px();
  const cv::Rect area(-border_px, -border_px, kSize.width + 2 * border_px, kSize.height + 2 * border_px);
  const cv::Mat clean = SinesPicture(kSize, plan.AroundPx());
  const auto render = [&](double distance, const ClipRenderer& by) {
    const MovingScene moving({Disc(0.5, 0.5, 1, 50, distance)}, Plan());
    RenderedFrame frame;
    by.Render(0, by.Prepare(clean), true, frame, {.strength = moving.At(0).Strength(area, {})});
    return frame;
  };
  const RenderedFrame half = render(0.5, renderer), none = render(0, renderer), full = render(1, renderer);
  const cv::Mat mask = MovingScene({Disc(0.5, 0.5, 1, 50)}, Plan()).At(0).Mask();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const float factor = 1 - 0.5f * mask.at<float>(y, x);
      const auto &whole = full.truth->tilt.at<cv::Vec2f>(y, x),
                 &scaled = half.truth->tilt.at<cv::Vec2f>(y, x);
      EXPECT_NEAR(scaled[0], factor * whole[0], 1e-6);
      EXPECT_NEAR(scaled[1], factor * whole[1], 1e-6);
      EXPECT_NEAR(half.truth->sigma.at<float>(y, x), factor * full.truth->sigma.at<float>(y, x), 1e-6);
      if (mask.at<float>(y, x) == 1) {
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(none.turb.at<cv::Vec3f>(y, x)[c],
                      clean.at<cv::Vec3f>(y + plan.AroundPx(), x + plan.AroundPx())[c], 1e-6);
      }
    }
  EXPECT_GT(full.tilt_square_px2, half.tilt_square_px2);
  // A factor of 1 changes no bit.
  scene.own_distances = false;
  const ClipPlan plain = PlanClip(scene, {.size = kSize, .frames = 1}, {});
  EXPECT_TRUE(SameBytes(full.turb, render(1, ClipRenderer(scene, plain, {0, 1})).turb));
}

// Where the object is seen in the shaken frame: at p + s.
TEST(MovingScene, StrengthFollowsTheShake) {
  const MovingScene moving({Disc(0.5, 0.5, 1, 30, 0)}, Plan());
  const cv::Rect area({-3, -2}, kSize);
  const auto middle_of = [&](cv::Point2d shake_px) {
    const cv::Mat strength = moving.At(0).Strength(area, shake_px);
    cv::Point2d sum;
    double all = 0;
    for (int y = 0; y < area.height; ++y)
      for (int x = 0; x < area.width; ++x) {
        const double covered = 1 - strength.at<float>(y, x);
        sum += cv::Point2d(area.x + x, area.y + y) * covered, all += covered;
      }
    return sum / all;
  };
  for (const cv::Point2d shake_px : {cv::Point2d(0, 0), cv::Point2d(5, -3), cv::Point2d(-2.25, 7.6)})
    EXPECT_LT(cv::norm(middle_of(shake_px) - cv::Point2d(79.5, 44.5) - shake_px), 1e-3) << shake_px;
}

// A file of half floats holds what was simulated, also where something was composed into it.
TEST(MovingScene, RoundsWhatItComposesAndNothingElse) {
  const auto to_tenths = [](cv::Mat& samples) {
    for (int y = 0; y < samples.rows; ++y)
      for (int x = 0; x < samples.cols * samples.channels(); ++x)
        samples.ptr<float>(y)[x] = std::round(samples.ptr<float>(y)[x] * 10) / 10;
  };
  const MovingScene moving({Disc(0.5, 0.5, 1, 30.3)}, Plan(), to_tenths);
  const cv::Mat background = SinesPicture(kSize, 0);
  cv::Mat samples = background.clone();
  const cv::Rect changed = moving.At(0).Over(samples, {}).at(0);
  const cv::Mat tenths = samples.clone();
  cv::Mat composed = tenths(changed);
  to_tenths(composed);
  EXPECT_TRUE(SameBytes(samples, tenths));
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      if (!changed.contains({x, y})) {
        EXPECT_EQ(samples.at<cv::Vec3f>(y, x), background.at<cv::Vec3f>(y, x));
      }
}

// An object larger than any picture, and one that shrinks to nothing, cost what is seen of them.
TEST(MovingScene, TakesNoMoreOfAnObjectThanIsSeen) {
  const auto growing = [](const Look& look, double rate) {
    return PlacedObject{
        MovingObject(look, {.scale_rate = rate, .off_frame = OffFrame::kAllow}, kSize, 100000, 8192, 0)};
  };
  const Look white = std::make_shared<const Cutout>(cv::Mat(7, 5, CV_32FC4, cv::Scalar::all(1)));
  for (const Look& look : {Look(DrawnLook{Shape::kDisc, kColour}), white}) {
    const cv::Mat covered = MovingScene({growing(look, 2)}, Plan()).At(99999).Mask();
    EXPECT_EQ(cv::countNonZero(covered == 1), kSize.area());
    EXPECT_LT(cv::sum(MovingScene({growing(look, 0.5)}, Plan()).At(99999).Mask())[0], 1e-3);
  }
  const cv::Rect area(-3, 5, 20, 30);
  EXPECT_EQ(growing(white, 2).object.At(99999, area).area, area);
}

}  // namespace
}  // namespace shimmer::sim
