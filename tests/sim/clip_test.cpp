#include "sim/clip.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <vector>

#include "sim/colour.h"
#include "sim/crop.h"
#include "sim/exact_blur.h"
#include "sim/gaussian.h"
#include "sim/warp.h"
#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

struct Rendering {
  ClipPlan plan;
  RenderedFrame frame;
};

Rendering RenderSines(const Scene& scene, cv::Size size, int64_t t = 3, int channels = 3,
                      ClipKey key = {0, 0}) {
  const ClipPlan plan = PlanClip(scene, {.size = size, .frames = 1}, {});
  return {plan, ClipRenderer(scene, plan, key).Render(t, SinesPicture(size, plan.halo_px, channels))};
}

// The picture lands where the field says: against the analytic picture at the true place, error in px by its
// slope.
TEST(ClipRenderer, PutsEveryPixelWhereTheFieldSays) {
  Scene scene;
  scene.blur.max_sigma_px = 0;
  for (double strength : {0.7, 5.0, 30.0}) {
    scene.tilt.strength_px = strength;
    const cv::Size size(131, 67);
    const auto [plan, frame] = RenderSines(scene, size);
    const TiltField field(scene.tilt, {0, 0});
    double sum2 = 0, worst = 0, worst_field = 0;
    int points = 0;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const auto d = field.Double(3, y, x);
        const auto stored = frame.truth.tilt.at<cv::Vec2f>(y, x);
        worst_field = std::max({worst_field, std::abs(d.x - stored[0]), std::abs(d.y - stored[1])});
        const double px = x + d.x, py = y + d.y, h = 1e-4;
        const double slope = std::hypot(SumOfSines(px + h, py) - SumOfSines(px - h, py),
                                        SumOfSines(px, py + h) - SumOfSines(px, py - h)) /
                             (2 * h);
        if (slope < 0.02) continue;
        const double error_px = std::abs(frame.turb.at<cv::Vec3f>(y, x)[0] - SumOfSines(px, py)) / slope;
        sum2 += error_px * error_px, worst = std::max(worst, error_px), ++points;
      }
    EXPECT_GT(points, 4000);
    EXPECT_LT(std::sqrt(sum2 / points), 0.01) << strength;  // what Catmull-Rom loses on periods of 14 px
    EXPECT_LT(worst, 0.06) << strength;
    EXPECT_LT(worst_field, 0.0035 * strength)
        << strength;  // at a face, kernel 0.6 may fall to the other side of its jump
  }
}

// The whole model by its twins, pixel by pixel in double: octaves, warp, map, and the Gaussian over warped
// pixels.
TEST(ClipRenderer, EqualsTheModelInDouble) {
  Scene scene;
  scene.tilt.strength_px = 3, scene.blur.max_sigma_px = 1.2, scene.blur.min_sigma_px = 0.2;
  scene.blur.method = BlurMethod::kExact;
  const cv::Size size(13, 9);
  const auto [plan, frame] = RenderSines(scene, size);
  const cv::Mat clean = SinesPicture(size, plan.halo_px);
  const TiltField field(scene.tilt, {0, 0});
  const BlurNoise noise(scene.blur, scene.tilt.lattice, {0, 0});
  const auto warped = [&](int x, int y, int c) {
    const auto d = field.Double(3, y, x);
    return WarpDouble(clean, x + plan.halo_px + d.x, y + plan.halo_px + d.y, c, Interpolation::kBicubic);
  };
  for (int y = 0; y < size.height; y += 2)
    for (int x = 0; x < size.width; x += 3) {
      const auto d = field.Double(3, y, x);
      const double sigma = 0.2 + 1.0 * (0.5 * Perlin01(noise.Double(3, y, x)) + 0.5 * Tilt01(d.x, d.y, 3));
      EXPECT_NEAR(frame.truth.sigma.at<float>(y, x), sigma, 1e-4);
      const int radius = GaussianRadius(sigma);
      for (int c = 0; c < 3; ++c) {
        double sum = 0, norm = 0;
        for (int j = -radius; j <= radius; ++j)
          for (int i = -radius; i <= radius; ++i) {
            const double w = std::exp(-0.5 * (i * i + j * j) / (sigma * sigma));
            sum += w * warped(x + i, y + j, c), norm += w;
          }
        EXPECT_NEAR(frame.turb.at<cv::Vec3f>(y, x)[c], sum / norm, 2e-5);  // 0.005 / 255
      }
    }
}

TEST(ClipRenderer, ACropOfAClipIsTheClipOfTheCrop) {
  Scene scene;
  const auto whole = RenderSines(scene, {90, 70}), part = RenderSines(scene, {33, 21});
  EXPECT_TRUE(SameBytes(whole.frame.turb(cv::Rect(0, 0, 33, 21)), part.frame.turb));
  EXPECT_TRUE(SameBytes(whole.frame.truth.tilt(cv::Rect(0, 0, 33, 21)), part.frame.truth.tilt));
  EXPECT_TRUE(SameBytes(whole.frame.truth.sigma(cv::Rect(0, 0, 33, 21)), part.frame.truth.sigma));
}

TEST(ClipRenderer, IsTheSameOnAnyNumberOfThreads) {
  std::vector<Rendering> renderings;
  for (size_t threads : {1, 2, 5}) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    renderings.push_back(RenderSines({}, {77, 55}));
  }
  for (const Rendering& r : renderings) EXPECT_TRUE(SameBytes(r.frame.turb, renderings[0].frame.turb));
}

// Each skip: the bytes of what is left are those of the full computation.
TEST(ClipRenderer, SkippingChangesNothing) {
  const cv::Size size(40, 30);
  Scene still;
  still.tilt.strength_px = 0, still.blur.max_sigma_px = 0;
  EXPECT_TRUE(SameBytes(RenderSines(still, size).frame.turb, SinesPicture(size, 0)));
  EXPECT_EQ(cv::countNonZero(RenderSines(still, size).frame.truth.sigma), 0);

  Scene frozen;
  frozen.tilt.temporal_scale = 0, frozen.blur.temporal_scale = 0;
  EXPECT_TRUE(
      SameBytes(RenderSines(frozen, size, 0).frame.turb, RenderSines(frozen, size, 12345).frame.turb));
  std::vector<float> dx(40), dy(40);  // the field itself, not the renderer's copy of frame 0
  TiltField(frozen.tilt, {0, 0}).Row(12345, 7, 0, dx, dy);
  for (int x = 0; x < 40; ++x)
    EXPECT_EQ(RenderSines(frozen, size, 12345).frame.truth.tilt.at<cv::Vec2f>(7, x), cv::Vec2f(dx[x], dy[x]));
  EXPECT_FALSE(SameBytes(RenderSines({}, size, 0).frame.turb, RenderSines({}, size, 1).frame.turb));

  Scene tiny;  // no tilt and nearly none
  tiny.tilt.strength_px = 1e-30;
  tiny.blur.tilt_weight = 0;
  Scene none = tiny;
  none.tilt.strength_px = 0;
  EXPECT_LT(cv::norm(RenderSines(tiny, size).frame.turb, RenderSines(none, size).frame.turb, cv::NORM_INF),
            1e-6);
}

// Sigmas are float32, and evenly spaced levels are sums: neither may read beyond the margin that the plan
// made. Seen by AddressSanitizer, and by the frame's edge, which nothing beyond may follow.
TEST(ClipRenderer, StaysWithinItsMarginWhateverRoundingDoes) {
  for (BlurMethod method : {BlurMethod::kExact, BlurMethod::kStack, BlurMethod::kAuto})
    for (int sixths = 1; sixths <= 24; ++sixths)
      for (double min_sigma_px : {0.0, 0.03, 0.07, 0.11, sixths / 6.0}) {
        Scene scene;
        scene.tilt.strength_px = 0;
        scene.blur.method = method;
        scene.blur.max_sigma_px = sixths / 6.0;
        scene.blur.min_sigma_px = std::min(min_sigma_px, scene.blur.max_sigma_px);
        const ClipPlan plan = PlanClip(scene, {.size = {3, 2}}, {});
        EXPECT_GE(plan.halo_px, GaussianRadius(static_cast<float>(scene.blur.max_sigma_px))) << sixths;
        const cv::Mat turb = RenderSines(scene, {3, 2}, 0).frame.turb;
        EXPECT_TRUE(cv::checkRange(turb, true, nullptr, 0, 1)) << sixths;
      }
}

TEST(ClipRenderer, SeedAndClipGiveOtherTurbulence) {
  const cv::Mat base = RenderSines({}, {30, 20}).frame.truth.tilt;
  EXPECT_FALSE(SameBytes(base, RenderSines({}, {30, 20}, 3, 3, {0, 1}).frame.truth.tilt));
  EXPECT_FALSE(SameBytes(base, RenderSines({}, {30, 20}, 3, 3, {1, 0}).frame.truth.tilt));
}

TEST(ClipRenderer, WorksOnAnySizeGreyOrColour) {
  for (cv::Size size : {cv::Size(1, 1), cv::Size(1, 17), cv::Size(17, 1), cv::Size(65, 3)})
    for (int channels : {1, 3}) {
      const auto [plan, frame] = RenderSines({}, size, 0, channels);
      EXPECT_EQ(frame.turb.size(), size);
      EXPECT_EQ(frame.turb.channels(), channels);
      EXPECT_TRUE(cv::checkRange(frame.turb, true, nullptr, -0.5, 1.5));
    }
}

TEST(ClipRenderer, StackIsNearTheExactBlur) {
  Scene scene;
  scene.blur.max_sigma_px = 4;
  scene.blur.method = BlurMethod::kExact;
  const cv::Mat exact = RenderSines(scene, {50, 40}).frame.turb;
  scene.blur.method = BlurMethod::kStack;
  const cv::Mat linear = RenderSines(scene, {50, 40}).frame.turb;
  scene.blur.level_choice = LevelChoice::kNearest;
  const cv::Mat nearest = RenderSines(scene, {50, 40}).frame.turb;
  const double error_linear = cv::norm(linear, exact, cv::NORM_L2),
               error_nearest = cv::norm(nearest, exact, cv::NORM_L2);
  EXPECT_GT(error_linear, 0);
  EXPECT_LT(error_linear, 0.3 * error_nearest);
}

TEST(ClipRenderer, LinearLightIsDecodedAndEncoded) {
  Scene scene;
  scene.colour = Colour::kLinear;
  scene.blur.method = BlurMethod::kExact;
  scene.tilt.strength_px = 0;
  scene.blur.min_sigma_px = scene.blur.max_sigma_px = 1.5;
  const cv::Size size(31, 22);
  const ClipPlan plan = PlanClip(scene, {.size = size}, {});
  const cv::Mat clean = SinesPicture(size, plan.halo_px);
  const cv::Mat turb = ClipRenderer(scene, plan, {0, 0}).Render(0, clean).turb;
  Scene stored = scene;
  stored.colour = Colour::kStored;
  const ClipPlan stored_plan = PlanClip(stored, {.size = size}, {});
  const ClipRenderer in_light(stored, stored_plan, {0, 0});
  EXPECT_LT(cv::norm(turb, EncodeSrgb(in_light.Render(0, DecodeSrgb(clean)).turb), cv::NORM_INF), 1e-6);
  EXPECT_GT(cv::norm(turb, in_light.Render(0, clean).turb, cv::NORM_INF), 0.002);  // and it matters
}

TEST(ClipRenderer, RefusesAFrameOfAnotherSizeOrType) {
  const ClipPlan plan = PlanClip({}, {.size = {20, 10}}, {});
  const ClipRenderer renderer({}, plan, {0, 0});
  EXPECT_THROW(renderer.Render(0, SinesPicture({20, 10}, 0)), std::invalid_argument);
  EXPECT_THROW(renderer.Render(0, cv::Mat()), std::invalid_argument);
  cv::Mat bytes;
  SinesPicture({20, 10}, plan.halo_px).convertTo(bytes, CV_8U);
  EXPECT_THROW(renderer.Render(0, bytes), std::invalid_argument);
}

TEST(CropWithHalo, TakesTheSourceWhereItIsAndReflectsBeyond) {
  const cv::Mat image = Picture({5, 4}, 0, 1, [](int x, int y, int) { return 10 * y + x; });
  const cv::Mat inside = CropWithHalo(image, {1, 1, 2, 1}, 1);
  EXPECT_EQ(inside.at<float>(0, 0), 0);
  EXPECT_EQ(inside.at<float>(2, 3), 23);
  const cv::Mat beyond = CropWithHalo(image, {0, 0, 5, 4}, 2);
  EXPECT_EQ(beyond.at<float>(2, 0), 2);  // columns 2 1 | 0 1 2 3 4 | 3 2
  EXPECT_EQ(beyond.at<float>(2, 8), 2);
  EXPECT_EQ(beyond.at<float>(0, 2), 20);
  const cv::Mat far = CropWithHalo(cv::Mat(1, 1, CV_32FC3, cv::Scalar(1, 2, 3)), {0, 0, 1, 1}, 500);
  EXPECT_EQ(far.at<cv::Vec3f>(0, 1000), cv::Vec3f(1, 2, 3));
}

TEST(Srgb, RoundTripsAndFollowsTheStandard) {
  cv::Mat ramp(1, 4097, CV_32F);
  for (int i = 0; i <= 4096; ++i) ramp.at<float>(i) = static_cast<float>(i) / 4096;
  EXPECT_LT(cv::norm(EncodeSrgb(DecodeSrgb(ramp)), ramp, cv::NORM_INF), 1e-6);
  const cv::Mat_<float> some = (cv::Mat_<float>(1, 4) << 0.f, 0.04f, 0.5f, 1.f);
  const cv::Mat light = DecodeSrgb(some);
  EXPECT_EQ(light.at<float>(0), 0);
  EXPECT_NEAR(light.at<float>(1), 0.04 / 12.92, 1e-7);
  EXPECT_NEAR(light.at<float>(2), std::pow((0.5 + 0.055) / 1.055, 2.4), 1e-6);
  EXPECT_NEAR(light.at<float>(3), 1, 1e-7);
  EXPECT_EQ(EncodeSrgb(cv::Mat_<float>(1, 1, -0.1f)).at<float>(0), 0);
}

}  // namespace
}  // namespace shimmer::sim
