#include "sim/clip.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <tbb/global_control.h>

#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
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

constexpr Accuracy kExact{.max_error_px = 0, .max_error_levels = 0};

Rendering RenderSines(const Scene& scene, cv::Size size, int64_t t = 3, int channels = 3,
                      ClipKey key = {0, 0}, const Accuracy& accuracy = {}) {
  const ClipPlan plan = PlanClip(scene, {.size = size, .frames = 1}, accuracy);
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
    const auto [plan, frame] = RenderSines(scene, size, 3, 3, {0, 0}, kExact);
    const TiltField field(scene.tilt, {0, 0});
    double sum2 = 0, worst = 0, worst_field = 0;
    int points = 0;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const auto d = field.Double(3, y, x);
        const auto stored = frame.truth->tilt.at<cv::Vec2f>(y, x);
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
  const cv::Size size(13, 9);
  const auto [plan, frame] = RenderSines(scene, size, 3, 3, {0, 0}, kExact);
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
      EXPECT_NEAR(frame.truth->sigma.at<float>(y, x), sigma, 1e-4);
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

// To the bit where it is exact; and within the budgets of both where octaves are evaluated as suits the size.
TEST(ClipRenderer, ACropOfAClipIsTheClipOfTheCrop) {
  Scene scene;
  const cv::Rect crop(0, 0, 33, 21);
  const auto exact = RenderSines(scene, {90, 70}, 3, 3, {0, 0}, kExact),
             exact_part = RenderSines(scene, crop.size(), 3, 3, {0, 0}, kExact);
  EXPECT_TRUE(SameBytes(exact.frame.turb(crop), exact_part.frame.turb));
  EXPECT_TRUE(SameBytes(exact.frame.truth->tilt(crop), exact_part.frame.truth->tilt));
  EXPECT_TRUE(SameBytes(exact.frame.truth->sigma(crop), exact_part.frame.truth->sigma));
  const auto whole = RenderSines(scene, {90, 70}), part = RenderSines(scene, crop.size());
  EXPECT_LE(cv::norm(whole.frame.truth->tilt(crop), part.frame.truth->tilt, cv::NORM_INF), 2 * 0.05);
  EXPECT_LE(cv::norm(whole.frame.turb(crop), part.frame.turb, cv::NORM_INF), 0.01);  // slopes up to 0.1 a px
}

TEST(ClipRenderer, IsTheSameOnAnyNumberOfThreads) {
  std::vector<Rendering> renderings;
  for (size_t threads : {1, 2, 5}) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    renderings.push_back(RenderSines({}, {77, 55}));
  }
  for (const Rendering& r : renderings) EXPECT_TRUE(SameBytes(r.frame.turb, renderings[0].frame.turb));
}

// A whole frame, kernels and all.
TEST(ClipRenderer, IsTheSameOnEveryTarget) {
  Scene scene;
  scene.colour = Colour::kLinear;
  scene.tilt.temporal_scale = scene.blur.temporal_scale = 0.05;  // with key frames
  std::optional<Rendering> first;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    const Rendering r =
        RenderSines(scene, {150, 40}, 3, 3, {0, 0}, {.max_error_px = 0.2, .max_error_levels = 1});
    if (!first) first = r;
    EXPECT_TRUE(SameBytes(r.frame.turb, first->frame.turb)) << hwy::TargetName(target);
    EXPECT_TRUE(SameBytes(r.frame.truth->tilt, first->frame.truth->tilt)) << hwy::TargetName(target);
    EXPECT_TRUE(SameBytes(r.frame.truth->sigma, first->frame.truth->sigma)) << hwy::TargetName(target);
    EXPECT_EQ(r.frame.mean_sigma_px, first->frame.mean_sigma_px) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

// Each skip: the bytes of what is left are those of the full computation.
TEST(ClipRenderer, SkippingChangesNothing) {
  const cv::Size size(40, 30);
  Scene still;
  still.tilt.strength_px = 0, still.blur.max_sigma_px = 0;
  EXPECT_TRUE(SameBytes(RenderSines(still, size).frame.turb, SinesPicture(size, 0)));
  EXPECT_EQ(cv::countNonZero(RenderSines(still, size).frame.truth->sigma), 0);

  Scene frozen;
  frozen.tilt.temporal_scale = 0, frozen.blur.temporal_scale = 0;
  EXPECT_TRUE(
      SameBytes(RenderSines(frozen, size, 0).frame.turb, RenderSines(frozen, size, 12345).frame.turb));
  std::vector<float> dx(40), dy(40);  // the field itself, not the renderer's copy of frame 0
  TiltField(frozen.tilt, {0, 0}).Row(12345, 7, 0, dx, dy);
  const auto exact = RenderSines(frozen, size, 12345, 3, {0, 0}, kExact);
  for (int x = 0; x < 40; ++x)
    EXPECT_EQ(exact.frame.truth->tilt.at<cv::Vec2f>(7, x), cv::Vec2f(dx[x], dy[x]));
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
        if (plan.blur && plan.blur->way != BlurWay::kLadder) {  // whose margin is its own promise
          EXPECT_GE(plan.halo_px, GaussianRadius(static_cast<float>(scene.blur.max_sigma_px))) << sixths;
        }
        const cv::Mat turb = RenderSines(scene, {3, 2}, 0).frame.turb;
        EXPECT_TRUE(cv::checkRange(turb, true, nullptr, 0, 1)) << sixths;
      }
}

TEST(ClipRenderer, SeedAndClipGiveOtherTurbulence) {
  const cv::Mat base = RenderSines({}, {30, 20}).frame.truth->tilt;
  EXPECT_FALSE(SameBytes(base, RenderSines({}, {30, 20}, 3, 3, {0, 1}).frame.truth->tilt));
  EXPECT_FALSE(SameBytes(base, RenderSines({}, {30, 20}, 3, 3, {1, 0}).frame.truth->tilt));
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
  const cv::Mat fine = SinesPicture({20, 10}, plan.halo_px);
  for (int type : {CV_8SC3, CV_64FC1, CV_8UC2, CV_32FC4})
    EXPECT_THROW(renderer.Render(0, cv::Mat::zeros(fine.size(), type)), std::invalid_argument) << type;
  for (float sample :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e5f}) {
    cv::Mat bad = fine.clone();
    bad.at<cv::Vec3f>(3, 4)[1] = sample;
    EXPECT_THROW(renderer.Render(0, bad), std::invalid_argument) << sample;
  }
}

// Frames of whole numbers: the float frame, rounded.
TEST(ClipRenderer, WorksOnTheSamplesOfFiles) {
  const cv::Size size(70, 41);
  const ClipPlan plan = PlanClip({}, {.size = size}, {});
  const ClipRenderer renderer({}, plan, {0, 0});
  for (const auto& [depth, top] : {std::pair(CV_8U, 255.0), std::pair(CV_16U, 65535.0)})
    for (int channels : {1, 3}) {
      cv::Mat samples, light, turb;
      SinesPicture(size, plan.halo_px, channels).convertTo(samples, depth, top);
      samples.convertTo(light, CV_32F, 1 / top);
      const cv::Mat rendered = renderer.Render(2, samples).turb;
      EXPECT_EQ(rendered.type(), samples.type());
      rendered.convertTo(turb, CV_32F, 1 / top);
      // Half a step of rounding, and what float32 may do to a tie
      EXPECT_LE(cv::norm(turb, renderer.Render(2, light).turb, cv::NORM_INF), 0.5001 / top + 1e-6);
    }
}

TEST(ClipRenderer, GreyStoredAsRgbIsRenderedAsGrey) {
  for (int depth : {CV_8U, CV_16U, CV_32F}) {
    const cv::Size size(67, 35);
    const ClipPlan plan = PlanClip({}, {.size = size}, {});
    const ClipRenderer renderer({}, plan, {0, 0});
    cv::Mat grey, rgb, as_one;
    SinesPicture(size, plan.halo_px, 1).convertTo(grey, depth, depth == CV_32F ? 1 : 200);
    cv::merge(std::vector{grey, grey, grey}, rgb);
    EXPECT_TRUE(renderer.Prepare(rgb).grey);
    const cv::Mat turb = renderer.Render(1, rgb).turb;
    const cv::Mat one = renderer.Render(1, grey).turb;
    cv::merge(std::vector{one, one, one}, as_one);
    EXPECT_TRUE(SameBytes(turb, as_one)) << depth;
    // A single sample that differs makes it colour, whose other channels are what they were.
    cv::Mat colour = rgb.clone();
    colour.col(3).row(2).setTo(cv::Scalar(1, 0, 0));
    EXPECT_FALSE(renderer.Prepare(colour).grey);
    cv::Mat green;
    cv::extractChannel(renderer.Render(1, colour).turb, green, 1);
    cv::extractChannel(colour, grey, 1);
    EXPECT_TRUE(SameBytes(green, renderer.Render(1, grey).turb)) << depth;
  }
}

// A page with a stain: what is far from it is copied, and what is near is as if nothing were skipped.
TEST(ClipRenderer, ConstantRegionsAreCopied) {
  for (Colour colour : {Colour::kStored, Colour::kLinear})
    for (bool blurred : {false, true}) {
      Scene scene;
      scene.colour = colour;
      if (!blurred) scene.blur.max_sigma_px = 0;
      const cv::Size size(300, 200);
      const ClipPlan plan = PlanClip(scene, {.size = size}, {});
      cv::Mat clean(size.height + 2 * plan.halo_px, size.width + 2 * plan.halo_px, CV_8UC3,
                    cv::Scalar(250, 240, 90));
      cv::circle(clean, {plan.halo_px + 150, plan.halo_px + 100}, 20, cv::Scalar(0, 80, 200), -1);
      const ClipRenderer renderer(scene, plan, {0, 0});
      const CleanFrame with = renderer.Prepare(clean);
      ASSERT_TRUE(with.constant.any());
      RenderedFrame skipped, whole;
      renderer.Render(0, with, true, skipped);
      CleanFrame without = with;
      without.constant = ConstantRegions(SinesPicture(clean.size(), 0));
      renderer.Render(0, without, true, whole);
      EXPECT_TRUE(SameBytes(skipped.turb, whole.turb));
      EXPECT_TRUE(SameBytes(skipped.truth->tilt, whole.truth->tilt));
      EXPECT_EQ(skipped.mean_sigma_px, whole.mean_sigma_px);
    }
}

// Where there is no tilt, blocks of two colours may lie side by side; and a ladder gathers from further than
// its margin. Neither may show: against the frame of which nothing is skipped.
TEST(ClipRenderer, ConstantRegionsEndWithoutAStep) {
  for (const double max_error_levels : {0.2, 0.5})
    for (const double sigma_px : {3.0, 8.0})
      for (const int edge_px : {151, 160, 171}) {
        Scene scene;
        scene.tilt.strength_px = 0;
        scene.blur.min_sigma_px = scene.blur.max_sigma_px = sigma_px;
        const ClipPlan plan = PlanClip(scene, {.size = {384, 64}}, {.max_error_levels = max_error_levels});
        const cv::Mat clean =
            Picture({384, 64}, plan.halo_px, 1, [&](int x, int, int) { return x >= edge_px; });
        const ClipRenderer renderer(scene, plan, {0, 0});
        const CleanFrame with = renderer.Prepare(clean);
        ASSERT_TRUE(with.constant.any());
        CleanFrame without = with;
        without.constant = ConstantRegions(SinesPicture(clean.size(), 0, 1));
        RenderedFrame skipped, whole;
        renderer.Render(0, with, false, skipped);
        renderer.Render(0, without, false, whole);
        // What a ladder's levels still gather from beyond six sigma: far below a tenth of a level
        EXPECT_LT(cv::norm(skipped.turb, whole.turb, cv::NORM_INF), 0.05 / 255) << sigma_px << " " << edge_px;
      }
}

// A spline may overshoot the field's bound by as much as the budget is; the margin holds the bound.
TEST(ClipRenderer, ShiftsStayWithinTheirBoundWhateverTheBudget) {
  Scene scene;
  scene.tilt = {.strength_px = 64, .base_frequency = 0.19, .octaves = 1, .kernel = 0.5};
  scene.blur.max_sigma_px = 0;
  bool reached = false;
  for (uint64_t clip = 0; clip < 20; ++clip) {
    const ClipPlan plan = PlanClip(scene, {.size = {256, 64}}, {.max_error_px = 64});
    const FrameTruth truth = ClipFields(scene, plan, {0, clip}).Truth(0);
    const double most = cv::norm(truth.tilt, cv::NORM_INF);
    EXPECT_LE(most, scene.tilt.BoundPx() * (1 + 1e-6));
    reached = reached || most > 0.999 * scene.tilt.BoundPx();
  }
  EXPECT_TRUE(reached);  // or else nothing was tested
}

TEST(ClipRenderer, SaysWhatItsFieldsAreLike) {
  const auto [plan, frame] = RenderSines({}, {61, 40});
  EXPECT_NEAR(frame.mean_sigma_px, cv::mean(frame.truth->sigma)[0], 1e-5);
  const double square = cv::norm(frame.truth->tilt, cv::NORM_L2SQR) / (2 * 61 * 40);
  EXPECT_NEAR(frame.tilt_square_px2, square, 1e-5 * square);
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
