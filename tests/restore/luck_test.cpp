#include "restore/luck.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "restore/plan.h"
#include "tests/restore/frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

// The energy of a scene whose contrast is doubled is four times as much: two octaves, but for the floor.
TEST(Luck, IsTheLogarithmOfTheEnergyOfDetail) {
  const cv::Mat scene = Noise({90, 70}, CV_8UC1, 1) / 4 + 64, more = (scene - 64) * 2 + 64;
  const cv::Mat luck = LuckOf(scene), luck_of_more = LuckOf(more);
  for (int y = 0; y < scene.rows; ++y)
    for (int x = 0; x < scene.cols; ++x)
      if (luck.at<uint8_t>(y, x) > 56) {  // 7 octaves: the floor is nothing beside it
        EXPECT_NEAR(luck_of_more.at<uint8_t>(y, x) - luck.at<uint8_t>(y, x), 16, 1);
      }
  EXPECT_GT(cv::countNonZero(luck > 56), 100);
}

TEST(Luck, OfNothingIsTheFloor) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC1}) {
    const cv::Mat luck = LuckOf(Flat({33, 21}, type, 100));
    EXPECT_EQ(cv::countNonZero(luck != static_cast<int>(8 * std::log2(kLuckFloor))), 0) << type;
  }
  EXPECT_EQ(LuckOf(Noise({1, 1}, CV_8UC3, 1)).size(), cv::Size(1, 1));
  EXPECT_THROW(LuckOf({}), std::invalid_argument);
}

TEST(Luck, IsOneWhateverTheThreadsAndBands) {
  const cv::Mat scene = Noise({50, 300}, CV_8UC3, 2), luck = LuckOf(scene);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(cv::norm(luck, LuckOf(scene), cv::NORM_INF), 0);
  // Of a part of the frame it is the same but near its edges.
  const cv::Range rows(40, 200), inside(20, 140);
  EXPECT_EQ(cv::norm(LuckOf(scene.rowRange(rows)).rowRange(inside), luck.rowRange(rows).rowRange(inside),
                     cv::NORM_INF),
            0);
}

TEST(Luck, WeighsByTheSquareOfTheEnergy) {
  for (uint32_t less = 0; less < 200; ++less)
    EXPECT_NEAR(LuckWeight(less) * std::pow(2, less / 4.0), 1, 0.07) << less;
  EXPECT_EQ(LuckWeight(0), 1);
  EXPECT_EQ(LuckWeight(1), 0.875);
  EXPECT_EQ(LuckWeight(8), 1 / 4.0);
  EXPECT_GT(LuckWeight(253), 0);
}

double SpreadOf(double most_blur_px, double tilt_px) {
  LuckSpread spread;
  for (uint32_t k = 0; k < 12; ++k) {
    cv::Mat frame = SeenFrame({.size = {200, 160}, .tilt_rms_px = tilt_px, .frame = k});
    if (most_blur_px > 0) cv::GaussianBlur(frame, frame, {}, 0.5 + most_blur_px * k / 11);
    spread.Add(frame, cv::Mat::zeros(frame.size(), CV_8UC1));
  }
  return spread.Octaves();
}

TEST(LuckSpread, TellsBlurThatChangesFromShifts) {
  EXPECT_LT(SpreadOf(0, 1), kLeastLuck_octaves);
  EXPECT_GT(SpreadOf(2, 0), kLeastLuck_octaves);
  EXPECT_GT(SpreadOf(2, 1), kLeastLuck_octaves);
  EXPECT_NEAR(SpreadOf(0, 0), 0, 1e-6);
}

TEST(LuckSpread, HiddenPxAndFewFramesSayNothing) {
  LuckSpread spread;
  EXPECT_EQ(spread.Octaves(), 0);
  const cv::Mat scene = SeenFrame({.size = {64, 64}});
  cv::Mat soft;
  cv::GaussianBlur(scene, soft, {}, 3);
  for (int k = 0; k < 8; ++k) {
    cv::Mat frame = scene.clone(), hidden = cv::Mat::zeros(scene.size(), CV_8UC1);
    if (k % 2 == 0) soft.copyTo(frame), hidden.setTo(255);
    spread.Add(frame, hidden);
    if (k < 3) {
      EXPECT_EQ(spread.Octaves(), 0);
    }
  }
  EXPECT_NEAR(spread.Octaves(), 0, 1e-6);
}

// A scene with texture and turbulence, whose blur changes.
TEST(LuckInThePlan, WantsBlurThatChangesAndFramesEnough) {
  VideoFacts facts{.size = {100, 80}, .type = CV_8UC1, .frames = kLeastLuckyFrames};
  facts.shifts.resize(kLeastLuckyFrames);
  facts.scene = SceneFacts();
  facts.scene->strength.texture = 0.5;
  facts.scene->strength.tilt_variance_px2 = 1;
  facts.scene->luck_octaves = kLeastLuck_octaves;
  EXPECT_TRUE(PlanRestore(facts, {}).lucky);
  facts.scene->luck_octaves = 0.9 * kLeastLuck_octaves;
  EXPECT_FALSE(PlanRestore(facts, {}).lucky);
  facts.scene->luck_octaves = kLeastLuck_octaves;
  facts.frames = kLeastLuckyFrames - 1;
  facts.shifts.pop_back();
  const RestorePlan few = PlanRestore(facts, {});
  EXPECT_TRUE(few.stack);
  EXPECT_FALSE(few.lucky);
}

}  // namespace
}  // namespace shimmer::restore
