#include "restore/baselines.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "restore/psnr.h"
#include "tests/restore/frames.h"
#include "tests/restore/memory_frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

constexpr Baseline kAll[] = {Baseline::kMean, Baseline::kMedian, Baseline::kLucky, Baseline::kSharpen};

std::vector<cv::Mat> Restored(Baseline baseline, const std::vector<cv::Mat>& frames) {
  MemoryFrames video(frames);
  std::vector<cv::Mat> restored;
  RestoreSimply(baseline, video, [&](const cv::Mat& frame) { restored.push_back(frame); });
  return restored;
}

std::vector<cv::Mat> NoiseFrames(int count, cv::Size size, int type) {
  std::vector<cv::Mat> frames;
  for (int k = 0; k < count; ++k) frames.push_back(Noise(size, type, static_cast<uint32_t>(k + 1)));
  return frames;
}

// Sample i of the frames that are nearest to frame k.
std::vector<double> Near(const std::vector<cv::Mat>& frames, int k, int i) {
  const int count = static_cast<int>(frames.size());
  const int first = std::clamp(k - kBaselineFrames / 2, 0, std::max(count - kBaselineFrames, 0));
  std::vector<double> samples;
  for (int n = first; n < std::min(first + kBaselineFrames, count); ++n) samples.push_back(frames[n].data[i]);
  return samples;
}

// To half a level, which is what rounding leaves.
TEST(Baselines, MeanAndMedianAreThoseOfTheFramesNearest) {
  for (const int count : {1, 2, 5, kBaselineFrames, kBaselineFrames + 8}) {
    const auto frames = NoiseFrames(count, {5, 3}, CV_8UC3);
    const auto mean = Restored(Baseline::kMean, frames), median = Restored(Baseline::kMedian, frames);
    ASSERT_EQ(std::ssize(mean), count);
    for (int k = 0; k < count; ++k)
      for (int i = 0; i < 5 * 3 * 3; ++i) {
        std::vector<double> samples = Near(frames, k, i);
        double sum = 0;
        for (const double sample : samples) sum += sample;
        EXPECT_NEAR(mean[k].data[i], sum / static_cast<double>(samples.size()), 0.5001);
        std::ranges::sort(samples);
        const size_t n = samples.size();
        EXPECT_NEAR(median[k].data[i], (samples[(n - 1) / 2] + samples[n / 2]) / 2, 0.5001);
      }
  }
}

TEST(Baselines, LuckyRegionsComeFromTheFrameThatIsSharpThere) {
  const cv::Size size(96, 48);
  const cv::Mat sharp = Blots(size, 3) / 2 + Noise(size, CV_8UC1, 4) / 2;
  cv::Mat soft;
  cv::GaussianBlur(sharp, soft, {}, 3);
  std::vector<cv::Mat> frames;
  for (int k = 0; k < 8; ++k) {
    frames.push_back(soft.clone());
    if (k == 2) sharp.colRange(0, 48).copyTo(frames.back().colRange(0, 48));
    if (k == 5) sharp.colRange(48, 96).copyTo(frames.back().colRange(48, 96));
  }
  const double lucky_db = Psnr(Restored(Baseline::kLucky, frames)[0], sharp),
               mean_db = Psnr(Restored(Baseline::kMean, frames)[0], sharp);
  EXPECT_GT(lucky_db, mean_db + 10);
}

TEST(Baselines, UnsharpMaskingPutsBackSomeOfWhatBlurTook) {
  const cv::Mat scene = SeenFrame({.size = {80, 60}});
  cv::Mat soft;
  cv::GaussianBlur(scene, soft, {}, 1.5);
  const cv::Mat restored = Restored(Baseline::kSharpen, {soft})[0];
  EXPECT_GT(Psnr(restored, scene), Psnr(soft, scene) + 1);
  EXPECT_EQ(restored.type(), CV_32FC1);
}

TEST(Baselines, AFlatVideoStaysAsItIsInAnyType) {
  for (const Baseline baseline : kAll)
    for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC3}) {
      const std::vector<cv::Mat> frames(4, Flat({1, 1}, type, 51));
      for (const cv::Mat& frame : Restored(baseline, frames)) {
        EXPECT_EQ(frame.type(), type);
        EXPECT_NEAR(LevelAt(frame, 0, 0, 0), 51, 1e-3);
      }
    }
}

TEST(Baselines, AreTheSameOnAnyNumberOfThreads) {
  const auto frames = NoiseFrames(6, {40, 37}, CV_8UC3);
  for (const Baseline baseline : kAll) {
    const auto all = Restored(baseline, frames);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const auto alone = Restored(baseline, frames);
    for (size_t k = 0; k < frames.size(); ++k) EXPECT_EQ(cv::norm(all[k], alone[k], cv::NORM_INF), 0);
  }
}

TEST(Baselines, FramesOfTwoSizesAreRefused) {
  for (const Baseline baseline : kAll)
    EXPECT_THROW(Restored(baseline, {Flat({4, 4}, CV_8UC1, 1), Flat({4, 5}, CV_8UC1, 1)}),
                 std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
