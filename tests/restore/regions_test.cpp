#include "restore/regions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "restore/psnr.h"
#include "restore/ssim.h"
#include "tests/restore/frames.h"

namespace shimmer::restore {
namespace {

const cv::Size kSizes[] = {{1, 1}, {7, 64}, {33, 65}, {90, 31}};

cv::Mat All(cv::Size size) { return cv::Mat(size, CV_8UC1, cv::Scalar(255)); }

TEST(Regions, TheWholeFrameScoresAsThoughItHadNoRegions) {
  for (const cv::Size size : kSizes)
    for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC1}) {
      const cv::Mat a = Noise(size, type, 1), b = Noise(size, type, 2);
      EXPECT_NEAR(*PsnrIn(a, b, {{All(size)}})[0], Psnr(a, b), 1e-11);
      EXPECT_NEAR(*SsimIn(a, b, {{All(size)}})[0], SsimOpenCv(a, b), 1e-12);
    }
}

// PSNR of a part is that of the part cut out; SSIM's windows see what is around it, so it is that of the mean
// over parts, weighed by their px.
TEST(Regions, AreMeasuredApart) {
  const cv::Size size(61, 50);
  const cv::Mat a = Noise(size, CV_8UC3, 3), b = Noise(size, CV_8UC3, 4);
  const cv::Rect place(5, 20, 30, 17);
  cv::Mat part = cv::Mat::zeros(size, CV_8UC1);
  part(place).setTo(1);
  const cv::Mat rest = All(size) & (part == 0);
  const std::vector<cv::Mat> regions = {part, rest, All(size)};
  EXPECT_NEAR(*PsnrIn(a, b, regions)[0], Psnr(a(place).clone(), b(place).clone()), 1e-11);
  const auto ssim = SsimIn(a, b, regions);
  const double share = static_cast<double>(place.area()) / size.area();
  EXPECT_NEAR(share * *ssim[0] + (1 - share) * *ssim[1], *ssim[2], 1e-12);
}

TEST(Regions, OneThatIsEmptyHasNoScore) {
  const cv::Size size(20, 40);
  const cv::Mat a = Noise(size, CV_8UC1, 5), b = Noise(size, CV_8UC1, 6),
                none = cv::Mat::zeros(size, CV_8UC1);
  EXPECT_EQ(PsnrIn(a, b, {{none}})[0], std::nullopt);
  EXPECT_EQ(SsimIn(a, b, {{none}})[0], std::nullopt);
  EXPECT_THAT(PsnrIn(a, b, {}), testing::IsEmpty());
  EXPECT_TRUE(std::isinf(*PsnrIn(a, a, {{All(size)}})[0]));
  EXPECT_THROW(PsnrIn(a, b, {{All({20, 39})}}), std::invalid_argument);
  EXPECT_THROW(SsimIn(a, b, {{cv::Mat(size, CV_32FC1)}}), std::invalid_argument);
}

TEST(Regions, AreTheSameOnAnyNumberOfThreads) {
  const cv::Size size(70, 333);
  const cv::Mat a = Noise(size, CV_8UC3, 7), b = Noise(size, CV_8UC3, 8);
  const auto both = std::pair(PsnrIn(a, b, {{All(size)}}), SsimIn(a, b, {{All(size)}}));
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(both, std::pair(PsnrIn(a, b, {{All(size)}}), SsimIn(a, b, {{All(size)}})));
}

TEST(Regions, ABoxGoesAroundAllOfOne) {
  cv::Mat region = cv::Mat::zeros(12, 20, CV_8UC1);
  EXPECT_EQ(cv::countNonZero(BoxAround(region)), 0);
  region.at<uint8_t>(3, 4) = 1;
  region.at<uint8_t>(9, 17) = 255;
  const cv::Mat box = BoxAround(region);
  EXPECT_EQ(cv::boundingRect(box), cv::Rect(4, 3, 14, 7));
  EXPECT_EQ(cv::countNonZero(box), 14 * 7);
}

}  // namespace
}  // namespace shimmer::restore
