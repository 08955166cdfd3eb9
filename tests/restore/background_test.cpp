#include "restore/background.h"

#include "restore/luck.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "restore/psnr.h"
#include "tests/restore/frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

struct Seen {
  SteadyFrame steady;
  cv::Mat moving = {};
};

std::vector<BackgroundFrame> Backgrounds(const std::vector<Seen>& frames, const BackgroundParams& params,
                                         const cv::Mat& start = {}) {
  Background background(params);
  if (!start.empty()) background.StartFrom(start);
  std::vector<BackgroundFrame> all;
  for (size_t k = 0; k < frames.size(); ++k) {
    const auto known = background.Next(frames[k].steady, frames[k].moving);
    const auto ahead = static_cast<size_t>(params.ahead);
    EXPECT_EQ(known.size(), k < 2 * ahead ? 0 : k == 2 * ahead ? ahead + 1 : 1);
    all.insert(all.end(), known.begin(), known.end());
  }
  while (const auto mean = background.Rest()) all.push_back(*mean);
  EXPECT_EQ(all.size(), frames.size());
  return all;
}

// The stated sums in double, a px at a time.
struct Twin {
  const std::vector<Seen>& frames;
  int ahead;
  std::vector<cv::Mat> lucks = {};  // of the frames; none: all px are as lucky

  double Gaussian(size_t j, size_t k) const {
    const double away = static_cast<double>(j) - static_cast<double>(k);
    return std::exp(-0.5 * std::pow(away / std::max(ahead, 1), 2));
  }
  // Of 255, what a px shows of the scene.
  static double Shows(const Seen& seen, int x, int y) {
    const double weight = seen.moving.empty() ? 255 : 255 - seen.moving.at<uint8_t>(y, x);
    const bool filled = !seen.steady.own.empty() && seen.steady.own.at<uint8_t>(y, x) == 0;
    return filled ? std::nearbyint(weight / 4) : weight;
  }
  // 0 within 12 px of what is hidden or filled.
  int LuckAt(size_t j, int x, int y) const {
    if (lucks.empty()) return 0;
    for (int v = std::max(y - 12, 0); v <= std::min(y + 12, lucks[j].rows - 1); ++v)
      for (int u = std::max(x - 12, 0); u <= std::min(x + 12, lucks[j].cols - 1); ++u)
        if (Shows(frames[j], u, v) < 255) return 0;
    return lucks[j].at<uint8_t>(y, x);
  }
  // Of sample c of a px of frame k's background; before: that of the frame before, NaN if it is not seen.
  double At(size_t k, int x, int y, int c, double before) const {
    double sum = 0, lucky = 0, own = 0, all = 0, as_they_are = 0;
    // The 2 ahead + 1 frames nearest in time, as far as there are so many.
    const auto beside = static_cast<size_t>(ahead), window = std::min(2 * beside + 1, frames.size());
    const size_t first = std::min(k < beside ? 0 : k - beside, frames.size() - window), end = first + window;
    int luckiest = 0;
    for (size_t j = first; j < end; ++j)
      if (Shows(frames[j], x, y) > 0) luckiest = std::max(luckiest, LuckAt(j, x, y));
    for (size_t j = first; j < end; ++j) {
      const Seen& seen = frames[j];
      const double weight = Shows(seen, x, y);
      const double level = LevelAt(seen.steady.frame, x, y, c), share = Gaussian(j, k);
      const int less = std::max(luckiest - LuckAt(j, x, y), 0);
      const double luck = std::pow(2, -(less / 4)) * (1 - 0.125 * (less % 4));
      sum += share * weight / 255 * luck * level, lucky += share * weight / 255 * luck;
      own += share * weight / 255;
      as_they_are += share * level, all += share;
    }
    const bool known = !std::isnan(before);
    const double missing = std::max(0.0, (known ? 0.25 : 0.01) * all - own);
    const double mean = lucky > 0 ? sum / lucky : 0;
    return (own * mean + missing * (known ? before : as_they_are / all)) / (own + missing);
  }
};

// Random frames and masks, of every kind and of odd sizes, against the twin.
TEST(Background, IsTheStatedMean) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3, CV_32FC1, CV_32FC3})
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(300, 5), cv::Size(33, 37)})
      for (const int ahead : {0, 1, 4}) {
        std::vector<Seen> frames;
        for (uint32_t k = 0; k < 11; ++k) {
          Seen seen{{Noise(size, type, k), {}}};
          if (k % 3 != 0) {
            seen.moving = Noise(size, CV_8UC1, 100 + k);
            seen.moving.setTo(255, Noise(size, CV_8UC1, 200 + k) > 100);
            seen.moving.colRange(0, size.width / 2) = k % 2 == 0 ? 0 : 255;
          }
          if (k % 4 == 1) seen.steady.own = Noise(size, CV_8UC1, 300 + k) > 128;
          frames.push_back(seen);
        }
        for (const bool lucky : {false, true}) {
          const auto found = Backgrounds(frames, {.ahead = ahead, .lucky = lucky});
          Twin twin{frames, ahead};
          if (lucky)
            for (const Seen& seen : frames) twin.lucks.push_back(LuckOf(seen.steady.frame));
          const double step = 255 / WhiteOf(CV_MAT_DEPTH(type)),
                       bound = CV_MAT_DEPTH(type) == CV_32F ? 1e-3 : 0.5 * step + 1e-3;
          for (size_t k = 0; k < found.size(); ++k)
            for (int y = 0; y < size.height; ++y)
              for (int x = 0; x < size.width; ++x)
                for (int c = 0; c < CV_MAT_CN(type); ++c) {
                  const bool known = k > 0 && found[k - 1].seen.at<uint8_t>(y, x) != 0;
                  const double before = known ? LevelAt(found[k - 1].frame, x, y, c) : NAN;
                  ASSERT_NEAR(LevelAt(found[k].frame, x, y, c), twin.At(k, x, y, c, before), bound)
                      << type << " " << size << " ahead " << ahead << " frame " << k << " px " << x << " "
                      << y;
                }
        }
      }
}

// An object that crosses: gone, and nothing is darker where it was.
TEST(Background, MovingObjectsAreGone) {
  const cv::Mat scene = Noise({90, 40}, CV_8UC3, 1);
  std::vector<Seen> frames;
  for (int k = 0; k < 30; ++k) {
    Seen seen{{scene.clone(), {}}, cv::Mat::zeros(scene.size(), CV_8UC1)};
    const cv::Rect car = cv::Rect(5 * k - 30, 10, 20, 20) & cv::Rect({0, 0}, scene.size());
    seen.steady.frame(car) = cv::Scalar(255, 0, 255);
    seen.moving(car) = 255;
    frames.push_back(seen);
  }
  for (const BackgroundFrame& mean : Backgrounds(frames, {.ahead = 5})) {
    EXPECT_EQ(cv::norm(mean.frame, scene, cv::NORM_INF), 0);
    EXPECT_EQ(cv::countNonZero(mean.seen), 90 * 40);
  }
}

// What is hidden for longer than the window keeps what was last seen of it.
TEST(Background, HiddenPxKeepWhatWasLastSeen) {
  std::vector<Seen> frames;
  for (int k = 0; k < 40; ++k) {
    Seen seen{{Flat({20, 10}, CV_8UC1, k < 10 ? 100 : 200), {}}, cv::Mat::zeros(10, 20, CV_8UC1)};
    if (k >= 10) seen.moving.colRange(0, 7) = 255;
    frames.push_back(seen);
  }
  const auto found = Backgrounds(frames, {.ahead = 4});
  for (size_t k = 0; k < 40; ++k) {
    EXPECT_EQ(found[k].frame.at<uint8_t>(5, 3), 100) << k;
    EXPECT_EQ(found[k].seen.at<uint8_t>(5, 3), 255) << k;
  }
  EXPECT_EQ(found[39].frame.at<uint8_t>(5, 12), 200);
}

// What no frame ever sees: the frames as they are, and said to be unseen; or what was known before.
TEST(Background, WhatNobodySees) {
  std::vector<Seen> frames;
  for (int k = 0; k < 9; ++k) {
    Seen seen{{Flat({20, 10}, CV_16UC3, 80), {}}, cv::Mat::zeros(10, 20, CV_8UC1)};
    seen.moving.colRange(0, 7) = 255;
    frames.push_back(seen);
  }
  for (const BackgroundFrame& mean : Backgrounds(frames, {.ahead = 2})) {
    EXPECT_EQ(cv::norm(mean.frame, frames[0].steady.frame, cv::NORM_INF), 0);
    EXPECT_EQ(mean.seen.at<uint8_t>(5, 6), 0);
    EXPECT_EQ(mean.seen.at<uint8_t>(5, 7), 255);
  }
  for (const BackgroundFrame& mean : Backgrounds(frames, {.ahead = 2}, Flat({20, 10}, CV_16UC3, 30))) {
    EXPECT_NEAR(LevelAt(mean.frame, 6, 5, 1), 30, 0.01);
    EXPECT_NEAR(LevelAt(mean.frame, 7, 5, 1), 80, 0.01);
    EXPECT_EQ(cv::countNonZero(mean.seen), 200);
  }
}

// Closed form: of two frames that weigh alike, one of them filled, the mean is 4 : 1.
TEST(Background, FilledPxWeighLess) {
  const cv::Mat filled = cv::Mat::zeros(6, 6, CV_8UC1);
  const std::vector<Seen> frames = {{{Flat({6, 6}, CV_32FC1, 100), {}}},
                                    {{Flat({6, 6}, CV_32FC1, 200), filled}}};
  const auto found = Backgrounds(frames, {.ahead = 1});
  const double side = std::exp(-0.5);  // sigma = 1 frame
  EXPECT_NEAR(LevelAt(found[0].frame, 3, 3, 0), (100 + side * 200 * 64 / 255.0) / (1 + side * 64 / 255.0),
              1e-3);
}

// No window: each frame as it is, bit by bit.
TEST(Background, WithoutAWindowFramesStay) {
  std::vector<Seen> frames;
  for (uint32_t k = 0; k < 3; ++k) frames.push_back({{Noise({31, 9}, CV_8UC3, k), {}}});
  const auto found = Backgrounds(frames, {.ahead = 0});
  for (size_t k = 0; k < 3; ++k) EXPECT_EQ(cv::norm(found[k].frame, frames[k].steady.frame, cv::NORM_INF), 0);
}

TEST(Background, IsTheSameOnAnyNumberOfThreads) {
  std::vector<Seen> frames;
  for (uint32_t k = 0; k < 8; ++k)
    frames.push_back({{SeenFrame({.size = {120, 90}, .tilt_rms_px = 1, .frame = k}), {}}, {}});
  for (const bool registered : {false, true}) {
    const auto many = Backgrounds(frames, {.ahead = 3, .registered = registered});
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const auto alone = Backgrounds(frames, {.ahead = 3, .registered = registered});
    for (size_t k = 0; k < frames.size(); ++k)
      EXPECT_EQ(cv::norm(many[k].frame, alone[k].frame, cv::NORM_INF), 0);
  }
}

// Turbulence and something that moves: registered means are nearer to the scene than plain ones.
TEST(Background, RegistrationHelps) {
  const cv::Size size(170, 131);
  std::vector<Seen> frames;
  for (uint32_t k = 0; k < 16; ++k) {
    const cv::Rect box(10 * static_cast<int>(k), 50, 30, 30);
    cv::Mat moving = cv::Mat::zeros(size, CV_8UC1);
    moving(box & cv::Rect({0, 0}, size)) = 255;
    frames.push_back({{SeenFrame({.size = size, .tilt_rms_px = 1.5, .frame = k, .box = box}), {}}, moving});
  }
  const cv::Mat scene = SeenFrame({.size = size});
  const auto plain = Backgrounds(frames, {.ahead = 7}),
             ours = Backgrounds(frames, {.ahead = 7, .registered = true}),
             known = Backgrounds(frames, {.ahead = 7, .registered = true, .scene = {scene * 255, {}}});
  for (size_t k = 0; k < frames.size(); ++k) {
    EXPECT_GT(Psnr(ours[k].frame, scene), Psnr(plain[k].frame, scene) + 0.5) << k;
    // The mean of 15 tilts of 1.5 px is off by 0.4 px, and more where the window is cut. Flows to the scene
    // itself leave less than half of it: 6 dB.
    EXPECT_GT(Psnr(known[k].frame, scene), Psnr(ours[k].frame, scene) + 6) << k;
  }
}

// Each frame is sharp in a part of the scene that another is not: the mean has the scene as sharp as they
// have it.
TEST(Background, IsAsSharpAsTheLuckiestFrames) {
  const cv::Mat scene = SeenFrame({.size = {160, 120}});
  std::vector<Seen> frames;
  for (int k = 0; k < 16; ++k) {
    cv::Mat frame;
    cv::GaussianBlur(scene, frame, {}, 3);
    const cv::Rect sharp(40 * (k % 4), 0, 40, 120);
    scene(sharp).copyTo(frame(sharp));
    frames.push_back({{frame, {}}, {}});
  }
  const auto plain = Backgrounds(frames, {.ahead = 8}),
             lucky = Backgrounds(frames, {.ahead = 8, .lucky = true});
  for (size_t k = 0; k < frames.size(); ++k)
    EXPECT_GT(Psnr(lucky[k].frame, scene), Psnr(plain[k].frame, scene) + 6) << k;
}

TEST(BackgroundFor, FollowsTheStrength) {
  const auto params = [](double tilt_px, Register registered) {
    TurbulenceStrength strength;
    strength.tilt_variance_px2 = tilt_px * tilt_px;
    return BackgroundFor(strength, registered);
  };
  EXPECT_EQ(params(0, Register::kAuto).ahead, 0);
  EXPECT_EQ(params(0.15, Register::kAuto).ahead, 7);
  EXPECT_EQ(params(0.3, Register::kAuto).ahead, 14);
  EXPECT_EQ(params(9, Register::kAuto).ahead, 14);
  int before = 0;
  for (double tilt_px = 0; tilt_px < 2; tilt_px += 0.01) {
    const int ahead = params(tilt_px, Register::kAuto).ahead;
    EXPECT_GE(ahead, before);
    before = ahead;
  }
  EXPECT_FALSE(params(0.2, Register::kAuto).registered);
  EXPECT_TRUE(params(0.3, Register::kAuto).registered);
  EXPECT_TRUE(params(0.1, Register::kOn).registered);
  EXPECT_FALSE(params(3, Register::kOff).registered);
}

TEST(Background, RefusesBadInput) {
  EXPECT_THROW(Background({.ahead = -1}), std::invalid_argument);
  EXPECT_THROW(Background({.ahead = 101}), std::invalid_argument);
  Background background({.ahead = 2});
  EXPECT_FALSE(background.Rest());
  EXPECT_THROW(background.Next({}), std::invalid_argument);
  background.Next({cv::Mat::zeros(8, 8, CV_8UC3), {}});
  EXPECT_THROW(background.Next({cv::Mat::zeros(8, 9, CV_8UC3), {}}), std::invalid_argument);
  EXPECT_THROW(background.Next({cv::Mat::zeros(8, 8, CV_8UC1), {}}), std::invalid_argument);
  const cv::Mat frame = cv::Mat::zeros(8, 8, CV_8UC3), wrong = cv::Mat::zeros(8, 9, CV_8UC1);
  EXPECT_THROW(background.Next({frame, {}}, wrong), std::invalid_argument);
  EXPECT_THROW(background.Next({frame, wrong}), std::invalid_argument);
  EXPECT_THROW(background.Next({frame, {}}, frame), std::invalid_argument);
  EXPECT_THROW(background.StartFrom(frame), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
