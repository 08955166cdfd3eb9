#include "restore/changing.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "restore/look.h"
#include "tests/restore/frames.h"
#include "tests/restore/memory_frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

// A picture in a frame of one colour, and something burnt into the frame.
std::vector<cv::Mat> Framed(const std::vector<cv::Mat>& pictures, cv::Size size, cv::Point at, double level) {
  std::vector<cv::Mat> framed;
  for (const cv::Mat& picture : pictures) {
    framed.push_back(Flat(size, picture.type(), level));
    cv::rectangle(framed.back(), cv::Rect(3, 2, 9, 4), cv::Scalar::all(200), cv::FILLED);
    picture.copyTo(framed.back()({at, picture.size()}));
  }
  return framed;
}

std::vector<cv::Mat> Pictures(int frames, cv::Size size, int type, double most_px) {
  std::vector<cv::Mat> pictures;
  for (int k = 0; k < frames; ++k) {
    cv::Mat picture;
    SeenFrame({.size = size, .shift = WanderingShift(k, most_px)})
        .convertTo(picture, CV_MAT_DEPTH(type), WhiteOf(CV_MAT_DEPTH(type)));
    if (CV_MAT_CN(type) == 3) cv::merge(std::vector<cv::Mat>(3, picture), picture);
    pictures.push_back(picture);
  }
  return pictures;
}

Changing Found(const std::vector<cv::Mat>& video, int64_t* reads = nullptr) {
  MemoryFrames frames(video);
  int64_t read = 0;
  const Changing changing = FindChanging(frames, [&] { ++read; });
  if (reads != nullptr) *reads = read;
  return changing;
}

TEST(FindChanging, IsThePictureInsideOfItsBars) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC1})
    for (const cv::Rect picture :
         {cv::Rect(0, 20, 160, 80), cv::Rect(31, 0, 97, 121), cv::Rect(17, 13, 90, 70)}) {
      const auto video = Framed(Pictures(4, picture.size(), type, 5), {160, 121}, picture.tl(), 16);
      const Changing changing = Found(video);
      EXPECT_EQ(changing.area, picture);
      EXPECT_EQ(cv::norm(changing.first, video[0], cv::NORM_INF), 0);
    }
}

// No bars: known from the second frame on.
TEST(FindChanging, ReadsTwoFramesWhereAllChanges) {
  int64_t reads = 0;
  const Changing changing = Found(Pictures(9, {120, 90}, CV_8UC1, 5), &reads);
  EXPECT_EQ(changing.area, cv::Rect(0, 0, 120, 90));
  EXPECT_TRUE(changing.first.empty());
  EXPECT_EQ(reads, 2);
}

// What changes once, late, is no bar.
TEST(FindChanging, SeesTheLastFrame) {
  auto video = Framed(Pictures(7, {160, 80}, CV_8UC3, 5), {160, 121}, {0, 20}, 16);
  video.back().at<cv::Vec3b>(118, 150)[2] ^= 1;
  EXPECT_EQ(Found(video).area, cv::Rect(0, 20, 160, 99));
}

TEST(FindChanging, LeavesSmallBarsAndStandingScenes) {
  // 4 % of the frame.
  EXPECT_TRUE(Found(Framed(Pictures(3, {160, 116}, CV_8UC1, 5), {160, 121}, {0, 5}, 16)).first.empty());
  // Nothing changes, or there is one frame.
  const cv::Mat still = Noise({64, 48}, CV_8UC3, 1);
  EXPECT_EQ(Found({still, still, still}).area, cv::Rect(0, 0, 64, 48));
  EXPECT_EQ(Found({still}).area, cv::Rect(0, 0, 64, 48));
  // A scene that stands bit by bit, and something that crosses it: the scene tells that the camera stands.
  std::vector<cv::Mat> crossed;
  for (int k = 0; k < 6; ++k) {
    cv::Mat frame;
    SeenFrame({.size = {160, 121}, .box = {40 + 5 * k, 50, 20, 20}}).convertTo(frame, CV_8U, 255);
    crossed.push_back(frame);
  }
  EXPECT_TRUE(Found(crossed).first.empty());
  // On a plain ground it is cut out, though to no less than can be looked at.
  const cv::Mat plain = Flat({64, 48}, CV_8UC1, 90);
  cv::Mat dot = plain.clone();
  dot.at<uchar>(47, 0) = 91;
  EXPECT_EQ(Found({plain, dot, plain}).area, cv::Rect(0, 32, 16, 16));
}

// A shaken picture in bars that stand: they must not draw the shifts to 0. (Looked at with its bars, which
// are without texture, these are the same to 0.01 px: it is the moved frames that must not have them.)
TEST(FindChanging, ShiftsAreThoseOfThePictureAlone) {
  const auto pictures = Pictures(30, {160, 90}, CV_8UC1, 9);
  MemoryFrames alone(pictures), framed(Framed(pictures, {160, 140}, {0, 25}, 0));
  const Changing changing = FindChanging(framed, [] {});
  Inside inside(framed, changing.area);
  const VideoFacts facts = LookAt(
                       inside, {}, [] {}, changing),
                   true_facts = LookAt(alone, {}, [] {});
  const VideoFacts with_bars = LookAt(framed, {}, [] {});
  EXPECT_EQ(facts.size, cv::Size(160, 90));
  for (size_t k = 0; k < pictures.size(); ++k) {
    EXPECT_EQ(facts.shifts[k].px, true_facts.shifts[k].px);
    EXPECT_LT(cv::norm(facts.shifts[k].px - WanderingShift(static_cast<int>(k), 9)), 0.1) << k;
    EXPECT_LT(cv::norm(with_bars.shifts[k].px - true_facts.shifts[k].px), 0.01) << k;
  }
}

// A grey picture between coloured bars is no grey video.
TEST(FindChanging, BarsMayBeInColour) {
  auto video = Framed(Pictures(3, {160, 80}, CV_8UC3, 5), {160, 121}, {0, 20}, 16);
  for (cv::Mat& frame : video) frame.row(120).setTo(cv::Scalar(0, 0, 200));
  MemoryFrames frames(video);
  const Changing changing = FindChanging(frames, [] {});
  Inside inside(frames, changing.area);
  EXPECT_TRUE(LookAt(inside, {}, [] {}).grey);
  EXPECT_FALSE(LookAt(
                   inside, {}, [] {}, changing)
                   .grey);
}

}  // namespace
}  // namespace shimmer::restore
