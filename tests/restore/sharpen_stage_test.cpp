// Sharpening as a stage of restoration: what the plan says of it, and where in the pipeline it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "restore/pipeline.h"
#include "tests/restore/box_sharpening.h"
#include "tests/restore/frames.h"
#include "tests/restore/memory_frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

constexpr TileSize kTile{.side_px = 64, .overlap_px = 16};

bool Same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

// Of a video of five frames whose scene has texture and such a tilt.
VideoFacts FactsOf(double tilt_px) {
  VideoFacts facts{.size = {100, 80}, .type = CV_8UC1, .frames = 5};
  facts.shifts.resize(5);
  facts.scene = SceneFacts();
  facts.scene->strength.texture = 0.5;
  facts.scene->strength.tilt_variance_px2 = tilt_px * tilt_px;
  return facts;
}

TEST(PlanSharpening, IsSwitchedOnByATile) {
  EXPECT_EQ(PlanRestore(FactsOf(1), {.sharpen = kTile}).sharpen, kTile);
  const RestorePlan off = PlanRestore(FactsOf(1), {});
  EXPECT_FALSE(off.sharpen);
  EXPECT_THAT(off.skipped, Contains("sharpening: it is switched off"));
}

TEST(PlanSharpening, LeavesStillAirAlone) {
  EXPECT_TRUE(PlanRestore(FactsOf(0.62), {.sharpen = kTile}).sharpen);
  const RestorePlan still = PlanRestore(FactsOf(0.58), {.sharpen = kTile});
  EXPECT_FALSE(still.sharpen);
  EXPECT_THAT(still.skipped, Contains("sharpening: the turbulence is too weak to need it"));
}

// Mist with nothing in it that moves.
TEST(PlanSharpening, LeavesAloneWhatHasNoTexture) {
  VideoFacts facts = FactsOf(0);
  facts.scene->strength.texture = 0;
  const RestorePlan mist = PlanRestore(facts, {.sharpen = kTile});
  EXPECT_FALSE(mist.sharpen);
  EXPECT_THAT(mist.skipped, Contains("sharpening: there is no texture that the air could blur"));
  facts.scene->moving_share = 0.01;
  EXPECT_TRUE(PlanRestore(facts, {.sharpen = kTile}).sharpen);
}

// Of one frame it is all that can be done. Frames that are all the same show no air.
TEST(PlanSharpening, IsForOneFrameToo) {
  VideoFacts facts{.size = {100, 80}, .type = CV_8UC1, .frames = 1, .alike = true};
  const RestorePlan one = PlanRestore(facts, {.sharpen = kTile});
  EXPECT_TRUE(one.sharpen);
  EXPECT_THAT(one.skipped, Contains(StartsWith("everything but sharpening: there is one frame")));
  facts.frames = 5;
  const RestorePlan alike = PlanRestore(facts, {.sharpen = kTile});
  EXPECT_FALSE(alike.sharpen);
  EXPECT_THAT(alike.skipped, Contains("everything: all frames are the same"));
}

TEST(PlanSharpening, RefusesFramesBelowAFixedTile) {
  TileSize fixed = kTile;
  fixed.fixed = true;
  fixed.side_px = 80;
  EXPECT_NO_THROW(PlanRestore(FactsOf(1), {.sharpen = fixed}));
  fixed.side_px = 81;
  EXPECT_THAT(
      [&] { PlanRestore(FactsOf(1), {.sharpen = fixed}); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("frames of 100x80 px: are smaller than the 81x81 px")));
}

struct Outcome {
  RestorePlan plan;
  std::vector<FrameOnWay> frames;
};

Outcome RunOn(const std::vector<cv::Mat>& video, RestoreParams params) {
  params.sharpen = kTile;
  MemoryFrames all(video);
  const Changing changing = FindChanging(all, [] {});
  Inside frames(all, changing.area);
  const VideoFacts facts = LookAt(
      frames, params.shake, [] {}, changing);
  Outcome run{.plan = PlanRestore(facts, params), .frames = {}};
  Sharpener sharpener(std::make_shared<BoxSharpening>(kTile), SharpenedSize(run.plan));
  Restore(frames, facts, run.plan, &sharpener, [&](const FrameOnWay& frame) { run.frames.push_back(frame); });
  return run;
}

std::vector<cv::Mat> Shaken(int frames) {
  std::vector<cv::Mat> video;
  for (int k = 0; k < frames; ++k)
    SeenFrame({.size = {160, 121}, .shift = WanderingShift(k, 9)})
        .convertTo(video.emplace_back(), CV_8U, 255);
  return video;
}

// What is put out is the stage before, sharpened; that stays beside it.
void ExpectSharpened(const Outcome& run, cv::Size size) {
  Sharpener sharpener(std::make_shared<BoxSharpening>(kTile), size);
  for (const FrameOnWay& frame : run.frames) {
    ASSERT_EQ(frame.blended.size(), size);
    EXPECT_TRUE(Same(frame.frame, sharpener.Next(frame.blended))) << frame.index;
    EXPECT_FALSE(Same(frame.frame, frame.blended));
  }
}

TEST(SharpenStage, IsTheLast) {
  for (const int count : {1, 7}) {
    const Outcome run = RunOn(Shaken(count), {.stack = false});
    ASSERT_EQ(std::ssize(run.frames), count);
    ExpectSharpened(run, {160, 121});
    for (const FrameOnWay& frame : run.frames)
      EXPECT_TRUE(count == 1 || Same(frame.blended, frame.steady)) << frame.index;
  }
}

TEST(SharpenStage, SeesWhatIsLeftOfACrop) {
  const Outcome run = RunOn(Shaken(7), {.border = Border::kCrop, .stack = false});
  ASSERT_LT(run.plan.area.width, 160);
  ExpectSharpened(run, run.plan.area.size());
}

TEST(SharpenStage, LeavesBarsAsTheyAre) {
  std::vector<cv::Mat> video;
  for (const cv::Mat& frame : Shaken(7)) {
    cv::copyMakeBorder(frame, video.emplace_back(), 20, 24, 0, 0, cv::BORDER_CONSTANT, cv::Scalar(0));
    video.back()(cv::Rect(30, 4, 40, 9)) = 200;  // something burnt in
  }
  const Outcome run = RunOn(video, {.stack = false});
  ASSERT_EQ(run.plan.picture, cv::Rect(0, 20, 160, 121));
  for (const FrameOnWay& frame : run.frames) {
    EXPECT_TRUE(Same(frame.frame.rowRange(0, 20), video[0].rowRange(0, 20)));
    EXPECT_TRUE(Same(frame.frame.rowRange(141, 165), video[0].rowRange(141, 165)));
    EXPECT_FALSE(Same(frame.frame(run.plan.picture), frame.blended));
  }
}

}  // namespace
}  // namespace shimmer::restore
