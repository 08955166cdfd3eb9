#include "restore/ssim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "tests/restore/frames.h"

namespace shimmer::restore {
namespace {

constexpr double kC1 = 6.5025, kC2 = 58.5225;

// A place that may lie beyond [0, count), by each border rule.
int Reflected101(int i, int count) {
  if (count == 1) return 0;
  while (i < 0 || i >= count) i = i < 0 ? -i : 2 * (count - 1) - i;
  return i;
}
int Replicated(int i, int count) { return std::clamp(i, 0, count - 1); }

struct Definition {
  std::vector<double> window;  // along one axis, of sum 1
  std::function<int(int, int)> place;
  int cropped;
  double variance_factor;
};

Definition Gaussian(std::function<int(int, int)> place) {
  std::vector<double> window;
  double sum = 0;
  for (int i = -5; i <= 5; ++i) window.push_back(std::exp(-i * i / 4.5)), sum += window.back();
  for (double& weight : window) weight /= sum;
  return {window, place, 0, 1};
}
Definition Flat7() { return {std::vector(7, 1.0 / 7), Replicated, 3, 49.0 / 48}; }

// Straight from the definition: each pixel's own window, variances about its mean.
double Twin(const cv::Size size, const std::function<double(int, int)>& a,
            const std::function<double(int, int)>& b, const Definition& by) {
  const int radius = static_cast<int>(by.window.size()) / 2;
  const auto mean = [&](int x, int y, const std::function<double(int, int)>& f) {
    double sum = 0;
    for (int v = -radius; v <= radius; ++v)
      for (int u = -radius; u <= radius; ++u)
        sum += by.window[static_cast<size_t>(u + radius)] * by.window[static_cast<size_t>(v + radius)] *
               f(by.place(x + u, size.width), by.place(y + v, size.height));
    return sum;
  };
  double sum = 0;
  int count = 0;
  for (int y = by.cropped; y < size.height - by.cropped; ++y)
    for (int x = by.cropped; x < size.width - by.cropped; ++x, ++count) {
      const double ma = mean(x, y, a), mb = mean(x, y, b);
      const auto off_a = [&](int u, int v) { return a(u, v) - ma; };
      const auto off_b = [&](int u, int v) { return b(u, v) - mb; };
      const double va = mean(x, y, [&](int u, int v) { return off_a(u, v) * off_a(u, v); });
      const double vb = mean(x, y, [&](int u, int v) { return off_b(u, v) * off_b(u, v); });
      const double c = mean(x, y, [&](int u, int v) { return off_a(u, v) * off_b(u, v); });
      sum += (2 * ma * mb + kC1) * (2 * by.variance_factor * c + kC2) /
             ((ma * ma + mb * mb + kC1) * (by.variance_factor * (va + vb) + kC2));
    }
  return sum / count;
}

double TwinOfFrames(const cv::Mat& a, const cv::Mat& b, const Definition& by) {
  double sum = 0;
  for (int c = 0; c < a.channels(); ++c)
    sum += Twin(
        a.size(), [&](int x, int y) { return LevelAt(a, x, y, c); },
        [&](int x, int y) { return LevelAt(b, x, y, c); }, by);
  return sum / a.channels();
}

double TwinOfY(const cv::Mat& a, const cv::Mat& b, const Definition& by) {
  const auto luma = [](const cv::Mat& frame) {
    return [&frame](int x, int y) {
      return 16 + (65.481 * LevelAt(frame, x, y, 0) + 128.553 * LevelAt(frame, x, y, 1) +
                   24.966 * LevelAt(frame, x, y, 2)) /
                      255;
    };
  };
  return Twin(a.size(), luma(a), luma(b), by);
}

// What a frame becomes on its way: half of another.
cv::Mat Mixed(const cv::Mat& frame, uint32_t seed) {
  cv::Mat mixed;
  cv::addWeighted(frame, 0.5, Noise(frame.size(), frame.type(), seed), 0.5, 0, mixed);
  return mixed;
}

// Sizes about the window's, and about the rows that are worked on at a time (32).
TEST(Ssim, EqualsItsDoubleTwin) {
  for (const cv::Size size : {cv::Size(7, 7), cv::Size(1, 13), cv::Size(12, 33), cv::Size(9, 37),
                              cv::Size(8, 38), cv::Size(5, 2), cv::Size(16, 70)})
    for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC3}) {
      SCOPED_TRACE(testing::Message() << size << " " << cv::typeToString(type));
      const cv::Mat a = Noise(size, type, 1), b = Mixed(a, 2);
      EXPECT_NEAR(SsimOpenCv(a, b), TwinOfFrames(a, b, Gaussian(Reflected101)), 1e-10);
      const auto scikit = SsimScikitImage(a, b);
      ASSERT_EQ(scikit.has_value(), size.width >= 7 && size.height >= 7);
      if (scikit) {
        EXPECT_NEAR(*scikit, TwinOfFrames(a, b, Flat7()), 1e-10);
      }
      EXPECT_NEAR(
          SsimY(a, b),
          a.channels() == 3 ? TwinOfY(a, b, Gaussian(Replicated)) : TwinOfFrames(a, b, Gaussian(Replicated)),
          1e-10);
    }
}

// Their borders and windows do make a difference, so that the twin tells one from another.
TEST(Ssim, TheDefinitionsDiffer) {
  const cv::Mat a = Noise({20, 20}, CV_8UC1, 3), b = Mixed(a, 4);
  EXPECT_GT(std::abs(SsimOpenCv(a, b) - SsimY(a, b)), 1e-4);
  EXPECT_GT(std::abs(SsimOpenCv(a, b) - *SsimScikitImage(a, b)), 1e-4);
}

TEST(Ssim, OfEqualFramesIsOne) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC3}) {
    const cv::Mat frame = Noise({40, 50}, type, 5);
    EXPECT_EQ(SsimOpenCv(frame, frame.clone()), 1);
    EXPECT_EQ(SsimScikitImage(frame, frame.clone()), 1);
    EXPECT_EQ(SsimY(frame, frame.clone()), 1);
  }
}

// Without variance only the means are left.
TEST(Ssim, OfFlatFrames) {
  for (const auto& [a, b] : {std::pair(0.0, 255.0), std::pair(51.0, 102.0), std::pair(255.0, 254.0)}) {
    const cv::Size size(9, 65);
    const auto expected = [](double ma, double mb) {
      return (2 * ma * mb + kC1) / (ma * ma + mb * mb + kC1);
    };
    const cv::Mat of_a = Flat(size, CV_8UC3, a), of_b = Flat(size, CV_8UC3, b);
    EXPECT_NEAR(SsimOpenCv(of_a, of_b), expected(a, b), 1e-10);
    EXPECT_NEAR(*SsimScikitImage(of_a, of_b), expected(a, b), 1e-10);
    EXPECT_NEAR(SsimY(of_a, of_b), expected(16 + 219 * a / 255, 16 + 219 * b / 255), 1e-10);
  }
}

// One window counts: the mean of 48 zeros and 255, and its sample variance.
TEST(SsimScikitImage, OfOneWindow) {
  cv::Mat dot = cv::Mat::zeros(7, 7, CV_8UC1);
  dot.at<uint8_t>(2, 5) = 255;
  const double mean = 255.0 / 49, variance = (255.0 * 255 - 49 * mean * mean) / 48;
  EXPECT_NEAR(*SsimScikitImage(dot, cv::Mat::zeros(7, 7, CV_8UC1)),
              kC1 * kC2 / ((mean * mean + kC1) * (variance + kC2)), 1e-12);
}

// The negative of a frame about grey: means equal, covariance minus the variance.
TEST(SsimScikitImage, OfTheNegative) {
  cv::Mat frame(7, 7, CV_8UC1, cv::Scalar(100)), negative(7, 7, CV_8UC1, cv::Scalar(100));
  for (int i = 0; i < 48; ++i) {
    frame.at<uint8_t>(i / 7, i % 7) = i % 2 ? 110 : 90;
    negative.at<uint8_t>(i / 7, i % 7) = i % 2 ? 90 : 110;
  }
  EXPECT_NEAR(*SsimScikitImage(frame, negative), (kC2 - 200) / (kC2 + 200), 1e-12);
}

// The very calls of OpenCV's sample, which has floats.
TEST(SsimOpenCv, IsThatOfOpenCvsCalls) {
  const cv::Mat bytes_a = Noise({90, 75}, CV_8UC3, 7), bytes_b = Mixed(bytes_a, 8);
  cv::Mat a, b;
  bytes_a.convertTo(a, CV_32F), bytes_b.convertTo(b, CV_32F);
  const auto blurred = [](const cv::Mat& values) {
    cv::Mat result;
    cv::GaussianBlur(values, result, {11, 11}, 1.5);
    return result;
  };
  const cv::Mat ma = blurred(a), mb = blurred(b), va = blurred(a.mul(a)) - ma.mul(ma),
                vb = blurred(b.mul(b)) - mb.mul(mb), c = blurred(a.mul(b)) - ma.mul(mb);
  const cv::Scalar c1 = cv::Scalar::all(kC1), c2 = cv::Scalar::all(kC2);
  const cv::Mat above = cv::Mat(2 * ma.mul(mb) + c1).mul(cv::Mat(2 * c + c2)),
                below = cv::Mat(ma.mul(ma) + mb.mul(mb) + c1).mul(cv::Mat(va + vb + c2));
  const cv::Scalar mean = cv::mean(above / below);
  EXPECT_NEAR(SsimOpenCv(bytes_a, bytes_b), (mean[0] + mean[1] + mean[2]) / 3, 1e-5);
}

TEST(Ssim, RefusesWhatCannotBeCompared) {
  const cv::Mat frame = Flat({8, 8}, CV_8UC1, 0);
  for (const cv::Mat& other : {Flat({8, 9}, CV_8UC1, 0), cv::Mat(), cv::Mat(8, 8, CV_64FC1)}) {
    EXPECT_THROW(SsimOpenCv(frame, other), std::invalid_argument);
    EXPECT_THROW(SsimScikitImage(frame, other), std::invalid_argument);
    EXPECT_THROW(SsimY(frame, other), std::invalid_argument);
  }
}

}  // namespace
}  // namespace shimmer::restore
