// Videos at the ends of what there is: each has a stated answer (docs/restoration.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "sim/dataset/numbered_name.h"
#include "tests/restore/app/unshimmer.h"
#include "tests/restore/frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore::app {
namespace {

using testing::HasSubstr;

namespace fs = std::filesystem;

std::string NameIn(const std::string& video, int k) { return video + "/" + dataset::Padded(k, 4) + ".png"; }

void Put(const TempFolder& folder, const std::string& video, int k, const cv::Mat& frame) {
  folder.Put(NameIn(video, k), dataset::EncodePng(frame, 8));
}

// Of a camera that wanders by a few px in air, over and over again.
void PutLong(const TempFolder& folder, const std::string& video, int frames, cv::Size size) {
  constexpr int kDistinct = 100;
  for (int k = 0; k < frames; ++k) {
    if (k >= kDistinct)
      fs::create_hard_link(folder / NameIn(video, k % kDistinct), folder / NameIn(video, k));
    else
      Put(folder, video, k,
          SeenFrame({.size = size,
                     .shift = WanderingShift(k, 3),
                     .tilt_rms_px = 0.7,
                     .frame = static_cast<uint32_t>(k)}));
  }
}

std::string PlanOf(const TempFolder& folder, const std::string& video, const Words& more = {}) {
  Words words = {"plan", video, "--quiet", "--no-sharpen"};
  words.insert(words.end(), more.begin(), more.end());
  const Ran plan = Unshimmer(folder, words);
  ExpectDone(plan);
  return plan.out;
}

void ExpectSame(const fs::path& a, const fs::path& b, int frames) {
  ASSERT_EQ(OpenFrames(b)->count(), frames);
  for (int k = 0; k < frames; ++k) EXPECT_EQ(cv::norm(FrameOf(a, k), FrameOf(b, k), cv::NORM_INF), 0) << k;
}

TEST(OddVideo, FramesAllAlikeComeOutAsTheyAre) {
  const TempFolder folder;
  const cv::Mat frame = SeenFrame({.size = {64, 64}});
  for (int k = 0; k < 5; ++k) Put(folder, "in", k, frame);
  EXPECT_THAT(PlanOf(folder, "in"),
              HasSubstr("stages    none\nskipped\n  everything: all frames are the same\n"));
  ExpectDone(Restored(folder, "in", "out"));
  ExpectSame(folder / "in", folder / "out", 5);
}

// A camera that pans by an eighth of the picture a frame.
TEST(OddVideo, MotionEverywhereComesOutAsItIs) {
  const TempFolder folder;
  const cv::Mat scene = Blots({560, 120}, 5);
  for (int k = 0; k < 20; ++k) Put(folder, "in", k, scene({20 * k, 0, 160, 120}).clone());
  EXPECT_THAT(PlanOf(folder, "in"), HasSubstr("stages    none\nskipped\n  everything: 1"));
  EXPECT_THAT(
      PlanOf(folder, "in"),
      HasSubstr(
          "frames show something else than those before, as the camera goes too far, or everything moves"));
  EXPECT_THAT(PlanOf(folder, "in", {"--no-stabilise"}), HasSubstr("stages    none\nskipped\n"));
  ExpectDone(Restored(folder, "in", "out"));
  ExpectSame(folder / "in", folder / "out", 20);
}

TEST(OddVideo, ACutIsNamed) {
  const TempFolder folder;
  const cv::Mat scenes[] = {Blots({200, 160}, 5), Blots({200, 160}, 6)};
  for (int k = 0; k < 24; ++k) {
    const cv::Point2d at = WanderingShift(k, 9);
    Put(folder, "in", k, scenes[k >= 12]({20 + cvRound(at.x), 20 + cvRound(at.y), 160, 120}).clone());
  }
  const Words says = {"frames 12 to 23 show another scene than those before",
                      "must be one scene. Split the video before frame 12"};
  ExpectRefused(Restored(folder, "in", "out"), 2, says);
  ExpectRefused(Unshimmer(folder, {"plan", "in", "--quiet"}), 2, says);
  for (const char* name : {"out", "out.part"}) EXPECT_FALSE(fs::exists(folder / name));
  ExpectDone(Restored(folder, "in", "out", {"--no-stabilise"}));
  EXPECT_EQ(OpenFrames(folder / "out")->count(), 24);
}

TEST(OddVideo, FramesOfOneDepthAndNumberOfChannels) {
  const TempFolder folder;
  const cv::Mat frame = SeenFrame({.size = {64, 64}});
  cv::Mat colour;
  cv::merge(std::vector<cv::Mat>{frame, frame, 0.5 * frame}, colour);
  for (int k = 0; k < 3; ++k) Put(folder, "channels", k, frame), Put(folder, "depth", k, frame);
  Put(folder, "channels", 2, colour);
  folder.Put(NameIn("depth", 1), dataset::EncodePng(frame, 16));
  ExpectRefused(Restored(folder, "channels", "out"), 1, {"0002.png: another size or number of channels"});
  ExpectRefused(Restored(folder, "depth", "out"), 2, {"frame is of another size or type than the first"});
}

// A video that ends in the middle of a frame is one of the frames that are whole; a line says so.
TEST(OddVideo, ATruncatedVideoIsOneOfItsWholeFrames) {
  const TempFolder folder;
  PutLong(folder, "in", 30, {96, 80});
  ExpectDone(Restored(folder, "in", "whole.avi", {"--no-stack"}));
  const std::string whole = ReadText(folder / "whole.avi");
  folder.Put("cut.avi", whole.substr(0, whole.size() * 2 / 3));
  const Ran ran = Restored(folder, "cut.avi", "out");
  const int64_t frames = OpenFrames(folder / "out")->count();
  EXPECT_GT(frames, 5);
  EXPECT_LT(frames, 29);
  ExpectOneLine(ran, 0,
                {"cut.avi: its header promises 30 frames, " + std::to_string(frames) + " can be decoded"},
                "unshimmer");
  ExpectDone(Restored(folder, "in", "whole.mp4", {"--no-stack"}));
  const std::string mp4 = ReadText(folder / "whole.mp4");
  folder.Put("cut.mp4", mp4.substr(0, mp4.size() / 2));  // its table of frames is at its end
  ExpectRefused(Restored(folder, "cut.mp4", "none"), 1, {"cut.mp4: "});
}

// A letterbox, by the program.
TEST(OddVideo, BarsStayAsTheyAre) {
  const TempFolder folder;
  const cv::Rect picture(0, 20, 160, 90);
  for (int k = 0; k < 12; ++k) {
    cv::Mat frame(130, 160, CV_32FC1, cv::Scalar(0));
    SeenFrame({.size = picture.size(), .shift = WanderingShift(k, 5)}).copyTo(frame(picture));
    Put(folder, "in", k, frame);
    Put(folder, "alone", k, frame(picture).clone());
  }
  EXPECT_THAT(
      PlanOf(folder, "in"),
      HasSubstr(
          "  bars around the picture: they never change, 30.77 % of the frame; 160x90 px from (0, 20) do\n"));
  ExpectDone(Restored(folder, "in", "out", {"--stages", "stages"}));
  ExpectDone(Restored(folder, "alone", "alone_out"));
  for (int k = 0; k < 12; ++k) {
    cv::Mat expected(130, 160, CV_8UC1, cv::Scalar(0));
    FrameOf(folder / "alone_out", k).copyTo(expected(picture));
    EXPECT_EQ(cv::norm(FrameOf(folder / "out", k), expected, cv::NORM_INF), 0) << k;
  }
  EXPECT_EQ(Json::parse(ReadText(folder / "stages/strength.json")).at("map_from_px"), Json({0, 20}));
}

TEST(OddVideo, SmallAndOfTwoFrames) {
  const TempFolder folder;
  PutLong(folder, "in", 2, {64, 64});
  ExpectDone(Restored(folder, "in", "out"));
  EXPECT_EQ(FrameOf(folder / "out", 1).size(), cv::Size(64, 64));
  for (int k = 0; k < 2; ++k) Put(folder, "tiny", k, SeenFrame({.size = {15, 64}, .shift = {1.0 * k, 0}}));
  ExpectRefused(Restored(folder, "tiny", "none"), 2, {"frame is 15x64 px, must be at least 16x16"});
}

TEST(OddVideo, FramesOf4K) {
  const TempFolder folder;
  cv::Mat scene = Blots({4000, 2320}, 1);
  cv::merge(std::vector<cv::Mat>{scene, 255 - scene, scene}, scene);
  for (int k = 0; k < 3; ++k) Put(folder, "in", k, scene({40 * k, 30 * k, 3840, 2160}).clone());
  ExpectDone(Restored(folder, "in", "out", {"--stages", "stages"}));
  EXPECT_EQ(FrameOf(folder / "out", 2).size(), cv::Size(3840, 2160));
  const Json plan = Json::parse(ReadText(folder / "stages/plan.json"));
  EXPECT_NEAR(plan.at("shifts_px")[2][0], -80, 0.2);
  EXPECT_NEAR(plan.at("shifts_px")[2][1], -60, 0.2);
}

// 2,000 frames, into a video and from it.
TEST(OddVideo, OfThousandsOfFrames) {
  const TempFolder folder;
  PutLong(folder, "in", 2000, {64, 64});
  ExpectDone(Restored(folder, "in", "out.mp4"));
  EXPECT_EQ(OpenFrames(folder / "out.mp4")->count(), 2000);
  EXPECT_THAT(PlanOf(folder, "out.mp4"), HasSubstr("frames    2,000 of 64x64 px, RGB, 8 bits\n"));
}

// Ten times as many frames: were they kept, 128x128 px would be 15 MB more. A shift is 64 bytes. On one
// thread, as others keep what they freed for themselves.
TEST(OddVideo, MemoryIsNoMatterOfLength) {
  const TempFolder folder;
  int64_t peak_bytes[2] = {};
  for (const int frames : {100, 1000}) {
    const std::string name = std::to_string(frames);
    PutLong(folder, name, frames, {128, 128});
    const Ran ran = Restored(folder, name, name + "_out", {"--threads", "1"});
    ExpectDone(ran);
    peak_bytes[frames == 1000] = ran.peak_bytes;
  }
  EXPECT_LT(peak_bytes[1], peak_bytes[0] + (10 << 20));
}

}  // namespace
}  // namespace shimmer::restore::app
