#include "restore/pipeline.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "restore/border_fill.h"
#include "restore/translate.h"
#include "tests/restore/frames.h"
#include "tests/restore/memory_frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

bool Same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

// A camera that wanders, in 8 bits.
std::vector<cv::Mat> Shaken(int frames, cv::Size size = {160, 121}, int channels = 1, double most_px = 9) {
  std::vector<cv::Mat> shaken;
  for (int k = 0; k < frames; ++k) {
    cv::Mat frame;
    SeenFrame({.size = size, .shift = WanderingShift(k, most_px)}).convertTo(frame, CV_8U, 255);
    shaken.push_back(channels == 1 ? frame : cv::Mat());
    if (channels == 3) cv::merge(std::vector{frame, frame, frame}, shaken.back());
  }
  return shaken;
}

struct Outcome {
  VideoFacts facts;
  RestorePlan plan;
  std::vector<FrameOnWay> frames;
};

Outcome RunOn(const std::vector<cv::Mat>& video, const RestoreParams& params = {}) {
  MemoryFrames all(video);
  const Changing changing = FindChanging(all, [] {});
  Inside frames(all, changing.area);
  Outcome run;
  int64_t looked_at = 0;
  run.facts = LookAt(
      frames, params.shake, [&] { ++looked_at; }, changing);
  EXPECT_EQ(looked_at, frames.count());
  if (params.stack && HasOneScene(run.facts, params)) {
    const bool moved = params.stabilise && !IsSteady(run.facts.shifts);
    int64_t reads = 0;
    run.facts.scene =
        LookAtScene(frames, moved ? run.facts.shifts : std::vector<FrameShift>(), run.facts.grey,
                    params.method, DisFlows(), params.registered, [&] { ++reads; });
    EXPECT_EQ(reads, ReadsOfLook(frames.count()));
  }
  run.plan = PlanRestore(run.facts, params);
  Restore(frames, run.facts, run.plan, nullptr, [&](const FrameOnWay& frame) {
    EXPECT_EQ(frame.index, std::ssize(run.frames));
    run.frames.push_back(frame);
  });
  EXPECT_EQ(std::ssize(run.frames), frames.count());
  return run;
}

bool Skips(const RestorePlan& plan, const std::string& start) {
  return std::ranges::any_of(plan.skipped, [&](const std::string& line) { return line.starts_with(start); });
}

// More frames than are aligned together, and fewer; fewer than filling looks ahead.
TEST(Restore, SteadiesAVideo) {
  for (const int count : {2, 5, 31}) {
    const std::vector<cv::Mat> video = Shaken(count);
    const Outcome run = RunOn(video, {.stack = false});
    ASSERT_TRUE(run.plan.stabilise && run.plan.fill);
    EXPECT_EQ(run.plan.area, cv::Rect({}, video[0].size()));
    const cv::Rect seen_by_all = CommonArea(run.facts.shifts, video[0].size());
    for (size_t k = 0; k < video.size(); ++k) {
      EXPECT_LT(cv::norm(run.facts.shifts[k].px - WanderingShift(static_cast<int>(k), 9)), 0.1) << k;
      // A resampled frame is the first one within its 8 bits and a tenth of a px of the scene's slopes.
      const cv::Rect inner(seen_by_all.x + 4, seen_by_all.y + 4, seen_by_all.width - 8,
                           seen_by_all.height - 8);
      EXPECT_LT(cv::norm(run.frames[k].frame(inner), video[0](inner), cv::NORM_L1) / inner.area(), 2.5) << k;
    }
  }
}

TEST(Restore, CropsToWhatAllFramesSee) {
  const std::vector<cv::Mat> video = Shaken(12, {150, 110}, 3);
  const Outcome run = RunOn(video, {.border = Border::kCrop, .stack = false});
  EXPECT_TRUE(run.facts.grey && run.plan.grey);
  EXPECT_EQ(run.plan.area, CommonArea(run.facts.shifts, video[0].size()));
  EXPECT_LT(run.plan.area.width, 150);
  for (size_t k = 0; k < video.size(); ++k) {
    cv::Mat grey;
    cv::extractChannel(video[k], grey, 0);
    EXPECT_TRUE(Same(run.frames[k].frame, Translated(grey, run.facts.shifts[k].px)(run.plan.area))) << k;
  }
}

TEST(Restore, IsTheSameOnAnyNumberOfThreads) {
  const std::vector<cv::Mat> video = Shaken(30);
  const Outcome many = RunOn(video);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Outcome alone = RunOn(video);
  for (size_t k = 0; k < video.size(); ++k)
    EXPECT_TRUE(Same(many.frames[k].frame, alone.frames[k].frame)) << k;
}

// What needs nothing is put out bit by bit, and the plan says why.
TEST(Restore, LeavesAloneWhatNeedsNothing) {
  const cv::Mat picture = Noise({40, 30}, CV_8UC3, 1);
  const std::pair<std::vector<cv::Mat>, const char*> cases[] = {
      {{picture}, "everything: there is one frame"},
      {std::vector<cv::Mat>(7, picture), "everything: all frames are the same"},
      {std::vector<cv::Mat>(3, Flat({33, 21}, CV_16UC1, 0)), "everything: all frames are the same"}};
  for (const auto& [video, why] : cases) {
    const Outcome run = RunOn(video);
    EXPECT_FALSE(run.plan.stabilise);
    EXPECT_TRUE(Skips(run.plan, why)) << why;
    for (const FrameOnWay& frame : run.frames) EXPECT_EQ(cv::norm(frame.frame, video[0], cv::NORM_INF), 0);
  }
  // A camera that stands: noise moves nothing by half a px.
  std::vector<cv::Mat> standing;
  for (uint32_t k = 0; k < 6; ++k)
    standing.push_back(SeenFrame({.size = {120, 90}, .frame = k, .noise = 0.02}));
  const Outcome run = RunOn(standing);
  EXPECT_FALSE(run.plan.stabilise || run.plan.stack);
  EXPECT_TRUE(Skips(run.plan, "stabilising: the camera stands"));
  EXPECT_TRUE(Skips(run.plan, "segmenting, stacking and blending: the turbulence is too weak"));
  for (size_t k = 0; k < standing.size(); ++k) EXPECT_TRUE(Same(run.frames[k].frame, standing[k]));
  EXPECT_FALSE(RunOn(Shaken(6), {.stabilise = false}).plan.stabilise);
}

// Bars around it stay as they are, bit by bit, and inside is what comes of the picture alone.
TEST(Restore, PutsBackTheBarsAroundAPicture) {
  const cv::Rect inside(0, 20, 160, 90);
  for (const int channels : {1, 3})
    for (const double most_px : {0.0, 9.0}) {
      std::vector<cv::Mat> pictures, video;
      for (int k = 0; k < 20; ++k) {
        cv::Mat picture;
        SeenFrame({.size = inside.size(),
                   .shift = WanderingShift(k, most_px),
                   .tilt_rms_px = 0.5,
                   .frame = static_cast<uint32_t>(k)})
            .convertTo(picture, CV_8U, 255);
        if (channels == 3) cv::merge(std::vector{picture, picture, picture}, picture);
        pictures.push_back(picture);
        video.push_back(cv::Mat(130, 160, picture.type(), cv::Scalar::all(16)));
        video.back()(cv::Rect(5, 115, 30, 9)).setTo(cv::Scalar(30, 30, channels == 3 ? 200 : 0));
        picture.copyTo(video.back()(inside));
      }
      const Outcome alone = RunOn(pictures), run = RunOn(video);
      EXPECT_EQ(run.plan.size, cv::Size(160, 130));
      EXPECT_EQ(run.plan.picture, inside);
      EXPECT_EQ(run.plan.stabilise, most_px > 0);
      EXPECT_TRUE(run.plan.stack);
      EXPECT_TRUE(Skips(run.plan, "bars around the picture: they never change, 30.77 % of the frame"));
      for (size_t k = 0; k < video.size(); ++k) {
        cv::Mat expected = video[0].clone(), picture = alone.frames[k].frame;
        if (channels == 3) cv::merge(std::vector{picture, picture, picture}, picture);  // (grey is one)
        picture.copyTo(expected(inside));
        EXPECT_TRUE(Same(run.frames[k].frame, expected)) << k;
      }
      if (most_px == 0) continue;
      const Outcome cropped = RunOn(video, {.border = Border::kCrop});
      EXPECT_EQ(cropped.plan.area, RunOn(pictures, {.border = Border::kCrop}).plan.area + inside.tl());
      EXPECT_EQ(cropped.frames[3].frame.size(), cropped.plan.area.size());
    }
}

// The whole of it: a shaken scene in strong air, a box that crosses it.
TEST(Restore, MakesATurbulentSceneClearAndKeepsWhatMoves) {
  constexpr int kFrames = 40;
  const cv::Size size(200, 150);
  std::vector<cv::Mat> video;
  const auto box_in = [](int k) { return cv::Rect(10 + 3 * k, 60, 36, 28); };
  for (int k = 0; k < kFrames; ++k) {
    const cv::Point2d shift = WanderingShift(k, 5);
    const cv::Point whole(cvRound(shift.x), cvRound(shift.y));
    cv::Mat frame;
    SeenFrame({.size = size,
               .shift = shift,
               .tilt_rms_px = 1,
               .frame = static_cast<uint32_t>(k),
               .box = box_in(k) + whole})
        .convertTo(frame, CV_8U, 255);
    video.push_back(frame);
  }
  cv::Mat clean;
  SeenFrame({.size = size}).convertTo(clean, CV_8U, 255);
  const Outcome run = RunOn(video), plain = RunOn(video, {.registered = Register::kOff});
  ASSERT_TRUE(run.plan.stabilise && run.plan.stack && run.plan.segment && run.plan.registered);
  EXPECT_FALSE(run.facts.scene->reference.grey.empty());
  EXPECT_TRUE(plain.facts.scene->reference.grey.empty());
  double before = 0, after = 0, unregistered = 0, kept = 0;
  const cv::Rect inner(12, 12, size.width - 24, size.height - 24);
  for (int k = 4; k < kFrames - 4; ++k) {
    const FrameOnWay& frame = run.frames[static_cast<size_t>(k)];
    cv::Mat still(size, CV_8UC1, cv::Scalar(255));
    const cv::Rect box = box_in(k) & cv::Rect({}, size),
                   around = (box_in(k) - cv::Point(6, 6)) + cv::Size(12, 12);
    still(around & cv::Rect({}, size)).setTo(0);
    before += cv::norm(frame.steady(inner), clean(inner), cv::NORM_L1, still(inner)) /
              cv::countNonZero(still(inner));
    after += cv::norm(frame.frame(inner), clean(inner), cv::NORM_L1, still(inner)) /
             cv::countNonZero(still(inner));
    unregistered +=
        cv::norm(plain.frames[static_cast<size_t>(k)].frame(inner), clean(inner), cv::NORM_L1, still(inner)) /
        cv::countNonZero(still(inner));
    const cv::Rect middle(box.x + 6, box.y + 6, std::max(1, box.width - 12), box.height - 12);
    kept += cv::norm(frame.frame(middle), frame.steady(middle), cv::NORM_L1) / middle.area();
  }
  EXPECT_LT(after, 0.6 * before);  // a mean of 29 frames of independent tilts: what is left is blur,
  // which registering takes out but for the mean tilt of the reference's frames.
  EXPECT_LT(after, 0.8 * unregistered);
  // Of 255: the box keeps its gradients (51 levels of texture); the membrane brings what the air does around
  // its mask, a px over the scene's slopes: 10 levels or so.
  EXPECT_LT(kept / (kFrames - 8), 15);
}

// Something that stands where it is for as long as the first frame's window is, and then drives off: what
// lies behind it is there from frame 0 on, as the look at the video found it.
TEST(Restore, KnowsWhatLiesBehindWhatStoodAtFirst) {
  const cv::Size size(200, 150);
  std::vector<cv::Mat> video;
  const auto box_in = [](int k) { return cv::Rect(40 + std::max(0, 9 * (k - 18)), 60, 36, 28); };
  for (int k = 0; k < 80; ++k) {
    cv::Mat frame = SeenFrame({.size = size,
                               .tilt_rms_px = 1,
                               .frame = static_cast<uint32_t>(k),
                               .box = box_in(k),
                               .box_in_air = true});
    if (const cv::Rect box = box_in(k) & cv::Rect({}, size); !box.empty()) frame(box) -= 0.3;  // dark
    frame.convertTo(video.emplace_back(), CV_8U, 255);
  }
  cv::Mat clean;
  SeenFrame({.size = size}).convertTo(clean, CV_8U, 255);
  const Outcome run = RunOn(video);
  ASSERT_TRUE(run.plan.stack && run.plan.segment);
  // Its inner px: what the mask may leave of its rim is another matter.
  const cv::Rect inner(box_in(0).x + 4, box_in(0).y + 4, 28, 20);
  const auto off = [&](const cv::Mat& frame) {
    return cv::norm(frame(inner), clean(inner), cv::NORM_L1) / inner.area();
  };
  EXPECT_GT(off(video[0]), 60);  // the box itself
  // (7 % of it look like the scene and are in no mask: they are what is left, most of it)
  for (const size_t k : {0u, 1u, 10u, 20u, 40u, 79u}) EXPECT_LT(off(run.frames[k].background), 12) << k;
  const FrameOnWay& first = run.frames[0];  // and it stands in front of it
  EXPECT_LT(cv::norm(first.frame(inner), video[0](inner), cv::NORM_L1) / inner.area(), 15);
}

// Where everything moves, or the camera pans out of its first picture, no mean of frames is a scene: they are
// put out as they are.
TEST(Restore, LeavesAloneWhatMovesEverywhere) {
  const cv::Mat scene = Blots({800, 120}, 5);
  const std::pair<int, const char*> cases[] = {{20, "everything: "},
                                               {2, "segmenting, stacking and blending: most of the picture"}};
  for (const auto& [px_a_frame, why] : cases) {
    std::vector<cv::Mat> video;
    for (int k = 0; k < 30; ++k) video.push_back(scene({px_a_frame * k, 0, 160, 120}).clone());
    // The slow one could be followed; not by a camera that is taken to stand.
    for (const SegmentMethod method : {SegmentMethod::kFused, SegmentMethod::kAof}) {
      const Outcome run = RunOn(video, {.stabilise = px_a_frame > 9, .method = method});
      EXPECT_FALSE(run.plan.stabilise || run.plan.segment || run.plan.stack);
      EXPECT_TRUE(Skips(run.plan, why)) << px_a_frame;
      for (size_t k = 0; k < video.size(); ++k) EXPECT_TRUE(Same(run.frames[k].frame, video[k])) << k;
    }
  }
  // Turbulence as strong as it comes moves every px too, but to and fro.
  std::vector<cv::Mat> strong;
  for (uint32_t k = 0; k < 24; ++k)
    SeenFrame({.size = {160, 120}, .tilt_rms_px = 3, .frame = k})
        .convertTo(strong.emplace_back(), CV_8U, 255);
  EXPECT_TRUE(RunOn(strong).plan.stack);
}

// A camera that goes into its scene: what it sees grows from frame to frame, which no shift follows.
TEST(Restore, LeavesAloneWhereTheCameraGoesAlong) {
  std::vector<cv::Mat> walk;
  for (uint32_t k = 0; k < 24; ++k) {
    cv::Mat frame;
    SeenFrame({.size = {240, 180}, .tilt_rms_px = 0.6, .frame = k}).convertTo(frame, CV_8U, 255);
    const double grown = std::pow(1.015, k);
    const cv::Matx23d about_middle(grown, 0, 120 * (1 - grown), 0, grown, 90 * (1 - grown));
    cv::warpAffine(frame, frame, about_middle, frame.size(), cv::INTER_CUBIC);
    walk.push_back(frame);
  }
  const Outcome run = RunOn(walk);
  EXPECT_FALSE(run.plan.stack);
  EXPECT_TRUE(Skips(run.plan, "segmenting, stacking and blending: most of the picture moves on"));
}

TEST(PlanRestore, NamesTheFrameWhereAnotherSceneBegins) {
  VideoFacts facts{.size = {100, 80}, .type = CV_8UC1, .frames = 30, .shifts = std::vector<FrameShift>(30)};
  for (size_t k = 20; k < 30; ++k) facts.shifts[k].match = Match::kLost;
  try {
    PlanRestore(facts, {});
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()).find("frames 20 to 29 show another scene than those before"), 0u);
  }
  EXPECT_NO_THROW(PlanRestore(facts, {.stabilise = false}));
}

TEST(LookAt, KnowsColourFromGreyInAnyDepth) {
  for (const int depth : {CV_8U, CV_16U, CV_32F}) {
    cv::Mat grey;
    cv::merge(std::vector<cv::Mat>(3, Noise({20, 17}, CV_MAKETYPE(depth, 1), 3)), grey);
    EXPECT_TRUE(RunOn({grey, grey}).facts.grey);
    cv::Mat coloured = grey.clone();
    coloured.row(16).col(19) = cv::Scalar(0, 1, 0);  // in the last px of the last frame
    EXPECT_FALSE(RunOn({grey, coloured}).facts.grey) << depth;
  }
}

TEST(PlanRestore, SaysWhereACropLeavesNothing) {
  VideoFacts facts{.size = {100, 80}, .type = CV_8UC1, .frames = 2};
  facts.shifts = {{}, {.px = {100, 0}}};
  EXPECT_THROW(PlanRestore(facts, {.border = Border::kCrop}), std::invalid_argument);
  EXPECT_NO_THROW(PlanRestore(facts, {}));
}

TEST(Restore, EndsWithWhatGoesWrong) {
  class Broken : public MemoryFrames {
   public:
    using MemoryFrames::MemoryFrames;
    cv::Mat Read(int64_t frame) override {
      if (broken_ && frame == 3) throw std::runtime_error("3 is broken");
      return MemoryFrames::Read(frame);
    }
    bool broken_ = false;
  };
  Broken video(Shaken(9));
  const VideoFacts facts = LookAt(video, {}, [] {});
  const RestorePlan plan = PlanRestore(facts, {});
  EXPECT_THROW(
      Restore(video, facts, plan, nullptr, [](const FrameOnWay&) { throw std::logic_error("full"); }),
      std::logic_error);
  video.broken_ = true;
  EXPECT_THROW(Restore(video, facts, plan, nullptr, [](const FrameOnWay&) {}), std::runtime_error);
}

}  // namespace
}  // namespace shimmer::restore
