#include "sim/constant_regions.h"

#include <gtest/gtest.h>

#include "noise/hash.h"
#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

TEST(ConstantRegions, FindsWhatIsConstantAndNothingElse) {
  cv::Mat frame(100, 130, CV_8UC3, cv::Scalar(10, 20, 30));
  EXPECT_TRUE(ConstantRegions(frame).IsConstant({0, 0, 130, 100}));
  frame.at<cv::Vec3b>(40, 70)[2] = 31;  // one sample: its block, rows 32 to 63 and columns 64 to 95
  const ConstantRegions regions(frame);
  EXPECT_TRUE(regions.any());
  EXPECT_FALSE(regions.IsConstant({0, 0, 130, 100}));
  EXPECT_FALSE(regions.IsConstant({70, 40, 1, 1}));
  EXPECT_TRUE(regions.IsConstant({0, 0, 64, 100}));
  EXPECT_TRUE(regions.IsConstant({96, 0, 34, 100}));
  EXPECT_TRUE(regions.IsConstant({0, 64, 130, 36}));
  EXPECT_FALSE(regions.IsConstant({63, 0, 2, 100}));
}

TEST(ConstantRegions, OfTwoColoursAreApart) {
  cv::Mat frame(64, 64, CV_32F, cv::Scalar(0.5));
  frame(cv::Rect(32, 0, 32, 64)).setTo(0.25);
  const ConstantRegions regions(frame);
  EXPECT_TRUE(regions.IsConstant({0, 0, 32, 64}));
  EXPECT_TRUE(regions.IsConstant({32, 0, 32, 64}));
  EXPECT_FALSE(regions.IsConstant({31, 0, 2, 64}));
}

// Whatever it calls constant is, seen pixel by pixel; what it calls varied may be either.
TEST(ConstantRegions, NeverCallsAVariedAreaConstant) {
  noise::HashStream stream(0);
  for (int round = 0; round < 200; ++round) {
    const int width = 1 + static_cast<int>(stream.Below(150)),
              height = 1 + static_cast<int>(stream.Below(80));
    cv::Mat frame(height, width, CV_16U, cv::Scalar(7));
    for (uint64_t spots = stream.Below(4); spots > 0; --spots)
      frame.at<uint16_t>(static_cast<int>(stream.Below(static_cast<uint64_t>(height))),
                         static_cast<int>(stream.Below(static_cast<uint64_t>(width)))) = 8;
    const ConstantRegions regions(frame);
    const int x = static_cast<int>(stream.Below(static_cast<uint64_t>(width))),
              y = static_cast<int>(stream.Below(static_cast<uint64_t>(height)));
    const cv::Rect area(x, y, width - x, height - y);
    const int reach = static_cast<int>(stream.Below(40));
    std::vector<bool> said(static_cast<size_t>(area.width), true);
    for (const cv::Range& part : regions.Varied(area, reach))
      for (int i = part.start; i < part.end; ++i) said[static_cast<size_t>(i)] = false;
    for (int i = 0; i < area.width; ++i) {
      if (!said[static_cast<size_t>(i)]) continue;
      const cv::Rect around = cv::Rect(x + i - reach, y - reach, 1 + 2 * reach, area.height + 2 * reach) &
                              cv::Rect({}, frame.size());
      double least, most;
      cv::minMaxLoc(frame(around), &least, &most);
      EXPECT_EQ(least, most) << round << " " << i;
    }
  }
}

TEST(ConstantRegions, OfAPhotographAreNone) {
  const ConstantRegions regions(SinesPicture({90, 40}, 0));
  EXPECT_FALSE(regions.any());
  EXPECT_EQ(regions.Varied({3, 4, 50, 6}, 5), std::vector<cv::Range>{cv::Range(0, 50)});
}

TEST(ConstantRegions, AreWellOnTheSmallestFrames) {
  for (cv::Size size : {cv::Size(1, 1), cv::Size(1, 17), cv::Size(17, 1), cv::Size(33, 1)})
    EXPECT_TRUE(ConstantRegions(cv::Mat(size, CV_8UC3, cv::Scalar(1, 2, 3))).IsConstant({{}, size}));
}

}  // namespace
}  // namespace shimmer::sim
