#include "restore/sharpen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/restore/box_sharpening.h"
#include "tests/restore/frames.h"

namespace shimmer::restore {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

cv::Mat InOne(const cv::Mat& frame) {
  BoxSharpening network({.side_px = 1000, .overlap_px = 0});
  return Sharpener(std::make_shared<BoxSharpening>(network), frame.size()).Next(frame);
}

// A tile's edge sees 1 px less, where its weight is 1 / 33 of the other's: 8 levels of 255 would be a fault.
TEST(Sharpen, TilesShowNoSeams) {
  const cv::Size size{150, 131};
  cv::Mat frame;
  cv::merge(std::vector{Blots(size, 1), Blots(size, 2), Blots(size, 3)}, frame);
  Sharpener sharpener(std::make_shared<BoxSharpening>(), frame.size());
  EXPECT_LE(cv::norm(sharpener.Next(frame), InOne(frame), cv::NORM_INF), 2);
  EXPECT_EQ(sharpener.counts(), (SharpenCounts{.computed = 9}));
}

TEST(Sharpen, KeepsSizeAndType) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3, CV_32FC1, CV_32FC3})
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(65, 47), cv::Size(7, 130)}) {
      const cv::Mat frame = Noise(size, type, 5);
      Sharpener sharpener(std::make_shared<BoxSharpening>(), size);
      const cv::Mat sharp = sharpener.Next(frame);
      EXPECT_EQ(sharp.size(), size);
      EXPECT_EQ(sharp.type(), type);
    }
}

// Grey as RGB is the same as grey, but for the rounding of their mean.
TEST(Sharpen, OfGreyIsThatOfThreeEqualChannels) {
  const cv::Mat grey = Noise({90, 70}, CV_32FC1, 6);
  cv::Mat colour, first;
  cv::merge(std::vector{grey, grey, grey}, colour);
  cv::extractChannel(InOne(colour), first, 0);
  EXPECT_LE(cv::norm(InOne(grey), first, cv::NORM_INF), 1e-6);
}

// Light beyond white is not cut off, and not sharpened further.
TEST(Sharpen, FloatsBeyondWhiteStayBeyond) {
  cv::Mat frame(40, 40, CV_32FC1, cv::Scalar(0.5));
  frame(cv::Rect(0, 0, 20, 40)) = 3.f;
  const cv::Mat sharp = InOne(frame);
  EXPECT_EQ(sharp.at<float>(20, 5), 3);
  EXPECT_GT(sharp.at<float>(20, 19), 3);
  EXPECT_LT(sharp.at<float>(20, 19), 3.2);
}

TEST(Sharpen, WhatIsNoNumberStaysWhereItIs) {
  cv::Mat frame = Noise({64, 64}, CV_32FC3, 10);
  frame.at<cv::Vec3f>(30, 31)[1] = std::numeric_limits<float>::quiet_NaN();
  frame.at<cv::Vec3f>(50, 3)[0] = std::numeric_limits<float>::infinity();
  const cv::Mat sharp = InOne(frame);
  int odd = 0;
  for (int y = 0; y < 64; ++y)
    for (int i = 0; i < 3 * 64; ++i) odd += !std::isfinite(sharp.ptr<float>(y)[i]);
  EXPECT_EQ(odd, 2);
}

// 64 px, 16 of them shared: 150x131 has 3x3 tiles.
TEST(Sharpen, ComputesOnlyWhatChanges) {
  const auto network = std::make_shared<BoxSharpening>();
  cv::Mat frame = Noise({150, 131}, CV_8UC3, 7);
  Sharpener sharpener(network, frame.size());
  const cv::Mat first = sharpener.Next(frame);
  const cv::Mat again = sharpener.Next(frame);
  EXPECT_EQ(cv::norm(first, again, cv::NORM_INF), 0);
  EXPECT_EQ(sharpener.counts(), (SharpenCounts{.computed = 9, .kept = 9}));
  frame(cv::Rect(2, 2, 30, 30)) = cv::Scalar::all(90);  // in the first tile alone
  sharpener.Next(frame);
  EXPECT_EQ(sharpener.counts(), (SharpenCounts{.computed = 10, .kept = 17}));
  EXPECT_EQ(network->calls, 10);
}

// Slow light: 0.1 levels a frame. The kept one is compared with what it was made of, not with the last frame.
TEST(Sharpen, DriftIsFollowed) {
  Sharpener sharpener(std::make_shared<BoxSharpening>(), {64, 64}, {.kept_levels = 0.25});
  const cv::Mat still = 0.5 * Noise({64, 64}, CV_32FC3, 8);
  for (int k = 0; k < 30; ++k) sharpener.Next(still + cv::Scalar::all(k * 0.1 / 255));
  EXPECT_EQ(sharpener.counts(), (SharpenCounts{.computed = 10, .kept = 20}));
}

// In 8 bits a tenth of a level is a step of one in each tenth px, and their RMS 0.32.
TEST(Sharpen, RoundingIsNoChange) {
  Sharpener sharpener(std::make_shared<BoxSharpening>(), {64, 64}, {.kept_levels = 0.25});
  const cv::Mat still = Noise({64, 64}, CV_32FC3, 8);
  for (int k = 0; k < 8; ++k) {
    cv::Mat frame;
    still.convertTo(frame, CV_8U, 200, 20 + 0.1 * k);
    sharpener.Next(frame);
  }
  // 0.2 levels are within 0.25 beside the rounding, 0.3 are not.
  EXPECT_EQ(sharpener.counts(), (SharpenCounts{.computed = 3, .kept = 5}));
}

// 4x4 px of 40 levels are 0.1 levels RMS of a tile of 384x384: too few to be seen in its mean.
TEST(Sharpen, ASmallThingThatMovesIsSeen) {
  Sharpener sharpener(std::make_shared<BoxSharpening>(TileSize{.side_px = 384, .overlap_px = 32}),
                      {384, 384});
  cv::Mat frame = Noise({384, 384}, CV_8UC3, 9);
  frame(cv::Rect(100, 100, 4, 4)) = cv::Scalar::all(100);
  sharpener.Next(frame);
  frame(cv::Rect(100, 100, 4, 4)) = cv::Scalar::all(140);
  sharpener.Next(frame);
  EXPECT_EQ(sharpener.counts(), (SharpenCounts{.computed = 2}));
}

TEST(Sharpen, FlatTilesPassAsTheyAre) {
  const auto network = std::make_shared<BoxSharpening>();
  Sharpener sharpener(network, {64, 64});
  const cv::Mat flat = Flat({64, 64}, CV_16UC3, 77);
  EXPECT_EQ(cv::norm(sharpener.Next(flat), flat, cv::NORM_INF), 0);
  EXPECT_EQ(sharpener.counts(), (SharpenCounts{.flat = 1}));
  EXPECT_EQ(network->calls, 0);
}

TEST(Sharpen, FramesSmallerThanAFixedTileAreRefused) {
  const auto network =
      std::make_shared<BoxSharpening>(TileSize{.side_px = 64, .overlap_px = 16, .fixed = true});
  EXPECT_NO_THROW(Sharpener(network, {64, 64}));
  EXPECT_THAT(([&] {
                Sharpener(network, {63, 100});
              }),
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("63x100 px: are smaller than the 64x64 px that the model takes")));
}

TEST(Sharpen, FramesOfAnotherSizeAreRefused) {
  Sharpener sharpener(std::make_shared<BoxSharpening>(), {64, 64});
  EXPECT_THROW(sharpener.Next(Noise({64, 65}, CV_8UC3, 1)), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
