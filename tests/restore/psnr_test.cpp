#include "restore/psnr.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/restore/frames.h"

namespace shimmer::restore {
namespace {

constexpr int kTypes[] = {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3, CV_32FC1, CV_32FC3};

// Floats hold a level to 1e-5 of it.
TEST(Psnr, OfADifferenceThatIsTheSameEverywhere) {
  for (const int type : kTypes)
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(33, 65), cv::Size(7, 64)})
      for (const double levels : {1.0, 17.0, 255.0})
        EXPECT_NEAR(Psnr(Flat(size, type, 0), Flat(size, type, levels)), 20 * std::log10(255 / levels), 1e-5)
            << cv::typeToString(type) << " " << size << " " << levels;
}

// MSE = 255^2 / (pixels * channels), wherever the sample is.
TEST(Psnr, OfOneSample) {
  for (const cv::Point at : {cv::Point(0, 0), cv::Point(39, 69), cv::Point(20, 32), cv::Point(3, 63)}) {
    const cv::Mat black = cv::Mat::zeros(70, 40, CV_8UC3);
    cv::Mat other = black.clone();
    other.at<cv::Vec3b>(at)[1] = 255;
    EXPECT_NEAR(Psnr(black, other), 10 * std::log10(70 * 40 * 3.0), 1e-12);
    EXPECT_EQ(Psnr(other, black), Psnr(black, other));
  }
}

TEST(Psnr, OfEqualFramesIsInfinite) {
  for (const int type : kTypes) {
    const cv::Mat frame = Noise({19, 41}, type, 1);
    EXPECT_EQ(Psnr(frame, frame.clone()), std::numeric_limits<double>::infinity());
    EXPECT_EQ(PsnrY(frame, frame.clone()), std::numeric_limits<double>::infinity());
  }
}

TEST(Psnr, IsThatOfOpenCv) {
  const cv::Mat a = Noise({101, 77}, CV_8UC3, 2), b = Noise({101, 77}, CV_8UC3, 3);
  EXPECT_NEAR(Psnr(a, b), cv::PSNR(a, b), 1e-9);
}

// 8 bits beside 16 beside floats: the same light is equal.
TEST(Psnr, ComparesTypesByTheirWhite) {
  const cv::Mat bytes = Noise({23, 35}, CV_8UC3, 4);
  cv::Mat words, floats;
  bytes.convertTo(words, CV_16U, 257);
  bytes.convertTo(floats, CV_32F, 1.0 / 255);
  EXPECT_EQ(Psnr(bytes, words), std::numeric_limits<double>::infinity());
  EXPECT_GT(Psnr(bytes, floats), 140);  // a float is within 2^-25 of its number
}

TEST(Psnr, FloatsOutsideOfTheRangeCountAsTheyAre) {
  EXPECT_NEAR(Psnr(Flat({5, 4}, CV_32FC1, -255), Flat({5, 4}, CV_32FC1, 2295)), -20, 1e-5);  // 10 times white
}

// Black to red of 255 is 65.481 levels of Y, to green 128.553, to blue 24.966.
TEST(PsnrY, IsOfItuBt601InStudioRange) {
  const double weights[] = {65.481, 128.553, 24.966};
  const cv::Mat black = cv::Mat::zeros(37, 9, CV_8UC3);
  for (int c = 0; c < 3; ++c) {
    cv::Scalar colour;
    colour[c] = 255;
    EXPECT_NEAR(PsnrY(black, cv::Mat(37, 9, CV_8UC3, colour)), 20 * std::log10(255 / weights[c]), 1e-9);
  }
  EXPECT_NEAR(PsnrY(black, Flat({9, 37}, CV_8UC3, 255)), 20 * std::log10(255.0 / 219), 1e-9);
}

// A grey frame is its own Y; beside an RGB one it is three equal channels.
TEST(PsnrY, OfGrey) {
  const cv::Mat a = Noise({21, 34}, CV_8UC1, 5), b = Noise({21, 34}, CV_8UC1, 6);
  EXPECT_EQ(PsnrY(a, b), Psnr(a, b));
  cv::Mat rgb;
  cv::merge(std::vector(3, b), rgb);
  EXPECT_NEAR(Psnr(a, rgb), Psnr(a, b), 1e-9);
  EXPECT_NEAR(PsnrY(a, rgb), Psnr(a, b) - 20 * std::log10(219.0 / 255), 1e-9);
  EXPECT_EQ(PsnrY(rgb, a), PsnrY(a, rgb));
}

TEST(Psnr, RefusesWhatCannotBeCompared) {
  const cv::Mat frame = Flat({8, 8}, CV_8UC1, 0);
  for (const auto psnr : {Psnr, PsnrY}) {
    EXPECT_THROW(psnr(frame, Flat({8, 9}, CV_8UC1, 0)), std::invalid_argument);
    EXPECT_THROW(psnr(frame, {}), std::invalid_argument);
    EXPECT_THROW(psnr(cv::Mat(8, 8, CV_8UC4), frame), std::invalid_argument);
    EXPECT_THROW(psnr(cv::Mat(8, 8, CV_32SC1), frame), std::invalid_argument);
    cv::Mat bad = Flat({8, 8}, CV_32FC1, 0);
    bad.at<float>(7, 7) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(psnr(frame, bad), std::invalid_argument);
  }
}

}  // namespace
}  // namespace shimmer::restore
