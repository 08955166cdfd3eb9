#include "restore/app/restore.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "restore/app/frame_source.h"
#include "tests/restore/app/unshimmer.h"
#include "tests/restore/frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore::app {
namespace {

using testing::HasSubstr;

namespace fs = std::filesystem;

std::string NameOf(int k) { return std::string(1, 'f') + std::to_string(1000 + k) + ".png"; }

// A camera that wanders by up to 6 px.
void PutShaken(const TempFolder& folder, const std::string& name, int frames, cv::Size size = {96, 75},
               int bits = 8) {
  for (int k = 0; k < frames; ++k)
    folder.Put(name + "/" + NameOf(k),
               dataset::EncodePng(SeenFrame({.size = size, .shift = WanderingShift(k, 6)}), bits));
}

TEST(RestoreVideo, WritesSteadyFramesOfTheirOwnBits) {
  for (const int bits : {8, 16}) {
    const TempFolder folder;
    PutShaken(folder, "in", 12, {96, 75}, bits);
    ExpectDone(Restored(folder, "in", "out", {"--stages", "stages"}));
    const auto out = OpenFrames(folder / "out");
    ASSERT_EQ(out->count(), 12);
    const cv::Mat first = FrameOf(folder / "in", 0);
    const double white = bits == 8 ? 255 : 65535;
    for (int k = 0; k < 12; ++k) {
      const cv::Mat frame = FrameOf(folder / "out", k);
      ASSERT_EQ(frame.type(), first.type());
      const cv::Rect inner(10, 10, 70, 50);
      EXPECT_LT(cv::norm(frame(inner), first(inner), cv::NORM_L1) / inner.area(), 0.01 * white) << k;
    }
    EXPECT_EQ(FrameOf(folder / "stages/stabilised", 5).size(), first.size());
    EXPECT_EQ(FrameOf(folder / "stages/own", 5).size(), first.size());
    const Json plan = Json::parse(ReadText(folder / "stages/plan.json"));
    ASSERT_EQ(plan.at("shifts_px").size(), 12u);
    EXPECT_NEAR(plan.at("shifts_px")[7][0], WanderingShift(7, 6).x, 0.1);
    EXPECT_FALSE(fs::exists(folder / "out.part"));
  }
}

TEST(RestoreVideo, CropsToWhatAllFramesSee) {
  const TempFolder folder;
  PutShaken(folder, "in", 9);
  ExpectDone(Restored(folder, "in", "out", {"--border", "crop"}));
  const cv::Size size = FrameOf(folder / "out", 0).size();
  EXPECT_LT(size.width, 96);
  EXPECT_GT(size.width, 80);
}

// Lossy, and of even sides: the last column and row are there twice.
TEST(RestoreVideo, WritesAVideo) {
  const TempFolder folder;
  PutShaken(folder, "in", 5, {97, 75});
  ExpectDone(Restored(folder, "in", "out", {}));
  for (const char* name : {"x.mp4", "x.mkv", "x.avi"}) {
    ExpectDone(Restored(folder, "in", name));
    const auto video = OpenFrames(folder / name);
    ASSERT_EQ(video->count(), 5) << name;
    EXPECT_DOUBLE_EQ(video->frames_per_s().value(), 25) << name;
    const cv::Mat shown = video->Read(2).pixels, frame = FrameOf(folder / "out", 2);
    ASSERT_EQ(shown.size(), cv::Size(98, 76));
    cv::Mat grey;
    cv::extractChannel(shown, grey, 1);
    EXPECT_LT(cv::norm(grey(cv::Rect({}, frame.size())), frame, cv::NORM_L1) / frame.size().area(), 4)
        << name;
  }
  // A video's own rate goes on.
  ExpectDone(Restored(folder, "in", "slow.mp4", {"--fps", "10"}));
  ExpectDone(Restored(folder, "slow.mp4", "again.mp4"));
  EXPECT_DOUBLE_EQ(OpenFrames(folder / "again.mp4")->frames_per_s().value(), 10);
}

// The folder of a clip means its turbulent frames.
TEST(RestoreVideo, TakesAClipOfShimmers) {
  const TempFolder folder;
  PutShaken(folder, "clip/turb", 3);
  folder.Put("clip/clean/0000.png", dataset::EncodePng(cv::Mat(75, 96, CV_32FC1, cv::Scalar(0)), 8));
  ExpectDone(Restored(folder, "clip", "out"));
  EXPECT_EQ(OpenFrames(folder / "out")->count(), 3);
}

// Fault 15: each kind of odd video has an answer.
TEST(RestoreVideo, RefusesWhatIsNoVideoInOneLine) {
  const TempFolder folder;
  PutShaken(folder, "gap", 5);
  fs::remove(folder / ("gap/" + NameOf(2)));
  ExpectRefused(Restored(folder, "gap", "out"), 1,
                {"gap: has no frame between f1001.png and f1003.png, must be numbered without gaps"});
  // Every second number is no gap; one of these that is missing is.
  PutShaken(folder, "odd", 7);
  for (const int k : {1, 3, 5}) fs::remove(folder / ("odd/" + NameOf(k)));
  ExpectDone(Restored(folder, "odd", "odd_out"));
  fs::remove(folder / ("odd/" + NameOf(2)));
  ExpectRefused(Restored(folder, "odd", "out"), 1, {"odd: has no frame between f1000.png and f1004.png"});
  PutShaken(folder, "sizes", 3);
  folder.Put("sizes/f1003.png", dataset::EncodePng(SeenFrame({.size = {97, 75}}), 8));
  ExpectRefused(Restored(folder, "sizes", "out"), 1, {"f1003.png: another size"});
  PutShaken(folder, "cut", 3);
  const std::string whole = ReadText(folder / "cut/f1002.png");
  folder.Put("cut/f1002.png", whole.substr(0, whole.size() / 2));
  ExpectRefused(Restored(folder, "cut", "out"), 1, {"f1002.png"});
  fs::create_directory(folder / "empty");
  ExpectRefused(Restored(folder, "empty", "out"), 1, {"empty"});
  ExpectRefused(Restored(folder, "nowhere", "out"), 1, {"nowhere: is not there"});
  folder.Put("text.mp4", "no video");
  ExpectRefused(Restored(folder, "text.mp4", "out"), 1, {"text.mp4"});
  for (const char* name : {"out", "out.part"}) EXPECT_FALSE(fs::exists(folder / name)) << name;

  PutShaken(folder, "in", 2);
  folder.Put("full/a.txt", "mine");
  ExpectRefused(Restored(folder, "in", "full"), 2, {"--out full: is there already"});
  ExpectRefused(Restored(folder, "in", "out", {"--stages", "full"}), 2, {"--stages full: is there already"});
  EXPECT_EQ(ReadText(folder / "full/a.txt"), "mine");
}

TEST(RestoreVideo, HasAnAnswerForVideosOfNothing) {
  const TempFolder folder;
  folder.Put("one/0.png", dataset::EncodePng(SeenFrame({.size = {64, 64}}), 8));
  for (int k = 0; k < 4; ++k)
    folder.Put("black/" + std::to_string(k) + ".png",
               dataset::EncodePng(cv::Mat(64, 64, CV_32FC3, cv::Scalar::all(0)), 8));
  for (const char* name : {"one", "black"}) {
    ExpectDone(Restored(folder, name, std::string(name) + "_out"));
    const cv::Mat given = FrameOf(folder / name, 0), out = FrameOf(folder / (std::string(name) + "_out"), 0);
    ASSERT_EQ(out.channels(), 1);  // three that are equal are one
    cv::Mat grey;
    cv::extractChannel(given, grey, 0);
    EXPECT_EQ(cv::norm(out, grey, cv::NORM_INF), 0);
    const Ran plan = Unshimmer(folder, {"plan", name, "--quiet", "--no-sharpen"});
    ExpectDone(plan);
    EXPECT_THAT(plan.out, HasSubstr("stages    none\nskipped\n"));
  }
}

TEST(RestoreVideo, PrintsItsPlan) {
  const TempFolder folder;
  PutShaken(folder, "in", 6);
  const Ran plan = Unshimmer(folder, {"plan", "in", "--quiet"});
  ExpectDone(plan);
  EXPECT_THAT(plan.out, HasSubstr("frames    6 of 96x75 px, grey, 8 bits\nshake     up to "));
  EXPECT_THAT(plan.out, HasSubstr("stages    stabilise and fill"));
}

// What an earlier run left, which was killed, is no frame of this one.
TEST(RestoreVideo, WhatAKilledRunLeftIsReplaced) {
  const TempFolder folder;
  PutShaken(folder, "in", 3);
  folder.Put("out.part/0007.png", "half");
  ExpectDone(Restored(folder, "in", "out"));
  EXPECT_EQ(OpenFrames(folder / "out")->count(), 3);
}

}  // namespace
}  // namespace shimmer::restore::app
