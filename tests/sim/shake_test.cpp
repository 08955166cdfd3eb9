// A shaking camera, as the renderer shows it.
#include <gtest/gtest.h>

#include "sim/clip.h"
#include "sim/drawn/drawn.h"
#include "sim/warp.h"
#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

const cv::Size kSize{90, 70};

Scene StillAir() {
  Scene scene;
  scene.tilt.strength_px = 0, scene.blur.max_sigma_px = 0;
  scene.camera = {.shake = Shake::kWalk, .amplitude_px = 4, .bound_px = 20};
  return scene;
}

// steady(p) = shaken(p + s): where the picture is known between its pixels, to what Catmull-Rom loses on
// periods of 14 px.
TEST(Shake, TheFrameIsSeenWhereItsTruthSays) {
  const Scene scene = StillAir();
  const ClipPlan plan = PlanClip(scene, {.size = kSize, .frames = 12}, {});
  const ClipRenderer renderer(scene, plan, {0, 0});
  const CleanFrame clean = renderer.Prepare(SinesPicture(kSize, plan.AroundPx()));
  const auto path = ShakePath(scene.camera, {0, 0}, 12);
  double most_px = 0;
  for (size_t k = 0; k < path.size(); ++k) {
    RenderedFrame frame;
    renderer.Render(static_cast<int64_t>(k), clean, true, frame, {.shake_px = path[k]});
    double worst = 0;
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x)
        worst = std::max(
            worst, std::abs(frame.turb.at<cv::Vec3f>(y, x)[0] - SumOfSines(x - path[k].x, y - path[k].y)));
    EXPECT_LT(worst, 0.002) << k;
    EXPECT_EQ(cv::norm(frame.truth->tilt, cv::NORM_INF), 0) << "the tilt is the turbulence's alone";
    most_px = std::max({most_px, std::abs(path[k].x), std::abs(path[k].y)});
  }
  EXPECT_GT(most_px, 5);
}

// Registered again by its truth, a shaken chart is the steady one but for two interpolations, whose error its
// twin in double shows alone.
TEST(Shake, AShakenChartIsRegisteredByItsTruth) {
  const Scene scene = StillAir();
  const ClipPlan plan = PlanClip(scene, {.size = kSize, .frames = 8}, {});
  const ClipRenderer renderer(scene, plan, {0, 3});
  const cv::Mat picture = DrawScene(DrawnScene::kChart, kSize, plan.AroundPx(), 3, 0);
  const CleanFrame clean = renderer.Prepare(picture);
  const int around_px = plan.AroundPx();
  for (const cv::Point2d& s : ShakePath(scene.camera, {0, 3}, 8)) {
    RenderedFrame frame;
    renderer.Render(0, clean, false, frame, {.shake_px = s});
    const cv::Mat twin = Picture(kSize, 0, 3, [&](int x, int y, int c) {
      return WarpDouble(picture, x - s.x + around_px, y - s.y + around_px, c, Interpolation::kBicubic);
    });
    double square = 0, twins_square = 0, unregistered = 0;
    int count = 0;
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        const cv::Point2d there = cv::Point2d(x, y) + s;
        if (there.x < 1 || there.y < 1 || there.x > kSize.width - 3 || there.y > kSize.height - 3) continue;
        const float steady = picture.at<cv::Vec3f>(y + around_px, x + around_px)[1];
        const auto registered = [&](const cv::Mat& shaken) {
          return WarpDouble(shaken, there.x, there.y, 1, Interpolation::kBicubic) - steady;
        };
        square += std::pow(registered(frame.turb), 2), twins_square += std::pow(registered(twin), 2);
        unregistered += std::pow(frame.turb.at<cv::Vec3f>(y, x)[1] - steady, 2), ++count;
      }
    const double levels = 255 * std::sqrt(square / count),
                 twins_levels = 255 * std::sqrt(twins_square / count);
    EXPECT_NEAR(levels, twins_levels, 1e-3) << s;
    EXPECT_LT(levels, 12) << s;  // edges of one px, interpolated twice
    if (cv::norm(s) > 1) {
      EXPECT_GT(unregistered, 10 * square) << s;
    }
  }
}

// By whole px nothing is resampled: the same turbulence over another part of the source, bit by bit.
TEST(Shake, ByWholePxIsAnotherCrop) {
  Scene scene;
  scene.camera = {.shake = Shake::kList, .shifts = {{0, 0}, {-7, 5}}};
  Scene stands = scene;
  stands.camera = {};
  const Accuracy exact{0, 0};
  const ClipPlan plan = PlanClip(scene, {.size = kSize, .frames = 2}, exact),
                 plain = PlanClip(stands, {.size = kSize, .frames = 2}, exact);
  EXPECT_EQ(plan.shake->reach_x_px, 7);
  EXPECT_EQ(plan.shake->reach_y_px, 5);
  const cv::Mat wide = SinesPicture(kSize, plan.AroundPx());
  const int off_px = plan.AroundPx() - plain.halo_px;
  for (const cv::Point s : {cv::Point(0, 0), cv::Point(-7, 5)}) {
    RenderedFrame shaken;
    ClipRenderer renderer(scene, plan, {0, 1});
    renderer.Render(1, renderer.Prepare(wide), false, shaken, {.shake_px = s});
    const cv::Rect crop(cv::Point(off_px, off_px) - s,
                        cv::Size(kSize.width + 2 * plain.halo_px, kSize.height + 2 * plain.halo_px));
    EXPECT_TRUE(
        SameBytes(shaken.turb, ClipRenderer(stands, plain, {0, 1}).Render(1, wide(crop).clone()).turb))
        << s;
  }
}

TEST(Shake, ThatIsNoneCostsNothing) {
  for (const CameraParams& camera : {CameraParams{.shake = Shake::kWalk, .amplitude_px = 0},
                                     CameraParams{.shake = Shake::kVibration, .amplitude_px = 0},
                                     CameraParams{.shake = Shake::kDrift, .bound_px = 0},
                                     CameraParams{.shake = Shake::kList, .shifts = {{3, 3}, {3, 3}}}}) {
    Scene scene;
    const ClipPlan plain = PlanClip(scene, {.size = kSize, .frames = 2}, {});
    scene.camera = camera;
    EXPECT_EQ(PlanClip(scene, {.size = kSize, .frames = 2}, {}), plain);
  }
}

TEST(Shake, BeyondWhatWasPreparedIsRefused) {
  const Scene scene = StillAir();
  const ClipPlan plan = PlanClip(scene, {.size = kSize, .frames = 2}, {});
  const ClipRenderer renderer(scene, plan, {0, 0});
  RenderedFrame frame;
  const CleanFrame clean = renderer.Prepare(SinesPicture(kSize, plan.AroundPx()));
  renderer.Render(0, clean, false, frame, {.shake_px = {20, -20}});
  EXPECT_THROW(renderer.Render(0, clean, false, frame, {.shake_px = {20.6, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::sim
