// What the benchmarks measure with is right: clocks, memory, the truth, and the methods of others.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "noise/perlin_double.h"
#include "noise/simplex_double.h"
#include "tests/bench/authors_method.h"
#include "tests/bench/double_pipeline.h"
#include "tests/bench/measure.h"
#include "tests/bench/opencv_method.h"
#include "tests/bench/scalar_noise.h"
#include "tests/bench/step.h"
#include "tests/sim/pictures.h"

namespace shimmer::bench {
namespace {

TEST(Measure, RunsOnceToWarmUpAndThenInBlocks) {
  std::vector<int> calls;
  const auto call = [&](int i) { calls.push_back(i); };
  const Timing blocks = Measure({.seconds = 1e3, .least_blocks = 1, .most_blocks = 2, .block_runs = 3}, call);
  EXPECT_EQ(calls, (std::vector{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(blocks.runs, 6);
  EXPECT_LE(blocks.best_wall_ms, blocks.wall_ms);
  calls.clear();
  Measure({.seconds = 0, .least_blocks = 2, .most_blocks = 9, .block_runs = 3}, call);
  EXPECT_EQ(calls, (std::vector{0, 1, 2}));  // no time for more
}

TEST(Measure, MedianIsTheMiddle) { EXPECT_EQ(Median({9, 1, 5}), 5); }

TEST(PeakMemory, CountsWhatIsTouchedAndFreedAgain) {
  constexpr int64_t kBytes = 64 << 20;
  const PeakMemory memory;
  { const std::vector<char> touched(kBytes, 1); }
  EXPECT_GE(memory.Bytes(), kBytes - (1 << 20));  // the kernel counts pages in batches
  EXPECT_LE(memory.Bytes(), 2 * kBytes);
}

TEST(ScalarNoise, IsTheLibrarysNoise) {
  const noise::Permutation& table = noise::ClassicPermutation();
  for (int i = 0; i < 2000; ++i) {
    // Off the faces, where both sides are right.
    const float x = (i * 37 % 1000) / 64.0f + 0.005f, y = (i * 91 % 777) / 64.0f + 0.011f,
                z = i / 64.0f + 0.017f;
    if (noise::SimplexFaceDistance(x, y, z) > 1e-5) {
      EXPECT_NEAR(ScalarSimplex(x, y, z), noise::SimplexDouble(table, noise::kSimplexKernel06, x, y, z),
                  1e-4);
    }
    EXPECT_NEAR(ScalarPerlin(x, y, z), noise::PerlinDouble(table, x, y, z), 1e-4);
  }
}

sim::Scene SmallScene() {
  sim::Scene scene;
  scene.tilt.strength_px = 4;
  scene.blur.max_sigma_px = 2;
  return scene;
}

TEST(AuthorsMethod, FastModeMirrorsOneFieldInTime) {
  const AuthorsMethod fast(SmallScene(), {30, 20}, 3, AuthorsMode::kFast);
  const std::vector<AuthorsMethod::Shifts> shifts = fast.ClipShifts();
  for (int t = 0; t < 3; ++t) EXPECT_TRUE(sim::SameBytes(shifts[t].dy, shifts[2 - t].dx));
  const AuthorsMethod full(SmallScene(), {30, 20}, 3, AuthorsMode::kFull);
  EXPECT_FALSE(sim::SameBytes(full.ClipShifts()[1].dy, full.ClipShifts()[1].dx));
}

TEST(AuthorsMethod, TakesTheNearestPixelBelowAndTheFramesExtremes) {
  const AuthorsMethod authors(SmallScene(), {8, 4}, 1, AuthorsMode::kFull);
  const cv::Mat clean = sim::SinesPicture({8, 4}, 0);
  const cv::Mat by(4, 8, CV_32F, cv::Scalar(1.9));
  const cv::Mat warped = authors.Warp(clean, {by, -by});
  EXPECT_EQ(warped.at<cv::Vec3f>(3, 2), clean.at<cv::Vec3f>(1, 3));
  EXPECT_EQ(warped.at<cv::Vec3f>(0, 7), clean.at<cv::Vec3f>(0, 7));  // the edge goes on

  double least, most;
  cv::minMaxLoc(authors.SigmaMap(0), &least, &most);
  EXPECT_NEAR(least, 0, 1e-5);
  EXPECT_NEAR(most, 2, 1e-5);
}

TEST(AuthorsMethod, CascadesToTheSigmaOfTheLevelBelow) {
  const cv::Size size(60, 60);
  sim::Scene scene = SmallScene();
  scene.blur.max_sigma_px = 5.5;  // steps of 0.5 px; sampled Gaussians of much smaller ones don't add up
  const AuthorsMethod authors(scene, size, 1, AuthorsMode::kFull);
  const cv::Mat clean = sim::SinesPicture(size, 0);
  const cv::Mat blurred = authors.Blur(clean, cv::Mat(size, CV_32F, cv::Scalar(2.9)));
  const auto distance = [&](int level) {
    cv::Mat expected;
    cv::GaussianBlur(clean, expected, {}, 0.5 * level, 0, cv::BORDER_REPLICATE);
    const cv::Rect inside(15, 15, 30, 30);
    return ErrorOf(blurred(inside), expected(inside)).rms;
  };
  EXPECT_LT(distance(5), distance(4));
  EXPECT_LT(distance(5), distance(6));
  EXPECT_TRUE(sim::SameBytes(authors.Blur(clean, cv::Mat(size, CV_32F, cv::Scalar(0))), clean));
}

TEST(OpenCv, CubicTwinIsRemapWhereItsTableIsExact) {
  const cv::Mat clean = sim::SinesPicture({24, 24}, 0, 1);
  const cv::Size size(12, 12);
  const cv::Mat dx(size, CV_32F, cv::Scalar(5 / 32.0)), dy(size, CV_32F, cv::Scalar(-19 / 32.0));
  const ExactShifts shifts{cv::Mat(size, CV_64F, cv::Scalar(5 / 32.0)),
                           cv::Mat(size, CV_64F, cv::Scalar(-19 / 32.0))};
  EXPECT_LT(ErrorOf(OpenCvWarp(clean, 6, dx, dy), ExactWarp(clean, 6, shifts, OpenCvCubicDouble)).max, 1e-6);
}

TEST(OpenCv, BlurMixesTheCopiesAroundASigma) {
  const cv::Mat frame = sim::SinesPicture({20, 20}, 20);
  const cv::Mat sigma(20, 20, CV_32F, cv::Scalar(1.0));  // a level of its own among 11 up to 2 px
  EXPECT_LT(ErrorOf(OpenCvBlur(frame, 20, sigma, 2), ExactBlur(frame, 20, sigma)).max, 1e-4);
  const cv::Mat none(20, 20, CV_32F, cv::Scalar(0));
  EXPECT_TRUE(sim::SameBytes(OpenCvBlur(frame, 20, none, 2), frame(cv::Rect(20, 20, 20, 20))));
}

// Catmull-Rom reproduces straight lines, a Gaussian too: everything but the shift drops out.
TEST(DoublePipeline, MovesARampByItsShifts) {
  const sim::Scene scene = SmallScene();
  const int margin_px = 8, border_px = 16;
  const cv::Size size(16, 12);
  const sim::TiltField field(scene.tilt, kBenchClip);
  const ExactShifts shifts = ExactTilt(field, size, border_px, 5);
  const int halo_px = margin_px + border_px;
  const cv::Mat ramp = sim::Picture(size, halo_px, 1, [](int x, int y, int) { return 0.01 * x + 0.003 * y; });
  const cv::Mat warped = ExactWarp(ramp, margin_px, shifts, CatmullRom);
  for (const cv::Point p : {cv::Point(0, 0), cv::Point(9, 7), cv::Point(15, 11)}) {
    const sim::TiltField::Shift shift = field.Double(5, p.y, p.x);
    EXPECT_NEAR(warped.at<float>(p.y + border_px, p.x + border_px),
                0.01 * (p.x + shift.x) + 0.003 * (p.y + shift.y), 1e-6);
  }
}

TEST(DoublePipeline, ErrorLeavesOutWhatItIsToldTo) {
  const cv::Mat a(1, 4, CV_32FC1, cv::Scalar(0));
  cv::Mat b = a.clone(), without(1, 4, CV_8U, cv::Scalar(0));
  b.at<float>(0, 1) = 3;
  b.at<float>(0, 2) = 4;
  EXPECT_NEAR(ErrorOf(a, b).rms, 2.5, 1e-12);
  EXPECT_EQ(ErrorOf(a, b).max, 4);
  without.at<uchar>(0, 2) = 255;
  EXPECT_NEAR(ErrorOf(a, b, without).rms, std::numbers::sqrt3, 1e-12);
  b.at<float>(0, 3) = NAN;
  EXPECT_TRUE(std::isnan(ErrorOf(a, b).max));
}

TEST(Step, KeepsTheDepthOfTheCleanFrame) {
  const cv::Size size(40, 30);
  Step step(SmallScene(), {.size = size}, {});
  const cv::Mat floats = sim::SinesPicture(size, step.halo_px());
  cv::Mat bytes, from_floats, from_bytes;
  floats.convertTo(bytes, CV_8U, 255);
  step.Prepare(floats);
  step.Render(2, from_floats);
  step.Prepare(bytes);
  step.Render(2, from_bytes);
  ASSERT_EQ(from_floats.type(), CV_32FC3);
  ASSERT_EQ(from_bytes.type(), CV_8UC3);
  from_bytes.convertTo(from_bytes, CV_32F, 1 / 255.0);
  // Half a level in, half a level out, and Catmull-Rom's overshoot of the first (its weights' sum of
  // magnitudes is at most 1.5625).
  EXPECT_LT(ErrorOf(from_floats, from_bytes).max, (0.5 * 1.5625 + 0.5 + 0.01) / 255);
}

}  // namespace
}  // namespace shimmer::bench
