#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <cmath>
#include <vector>

#include "noise/hash.h"
#include "sim/exact_blur.h"
#include "sim/gaussian.h"
#include "sim/stack_blur.h"
#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

cv::Mat ExactBlur(const cv::Mat& frame, int border_px, const cv::Mat& sigma) {
  cv::Mat out(sigma.size(), frame.type());
  for (int y = 0; y < sigma.rows; ++y)
    ExactBlurRow(frame, {border_px, y + border_px}, {sigma.ptr<float>(y), static_cast<size_t>(sigma.cols)},
                 out.ptr<float>(y));
  return out;
}

// A bright pixel in the middle; its neighbourhood in sum is the kernel itself.
cv::Mat Impulse(int size, int border_px) {
  cv::Mat frame = cv::Mat::zeros(size + 2 * border_px, size + 2 * border_px, CV_32F);
  frame.at<float>(size / 2 + border_px, size / 2 + border_px) = 1;
  return frame;
}

TEST(GaussianWeights, AreNormalisedAndGaussian) {
  std::vector<double> w;
  for (double sigma : {1e-12, 0.1, 0.3, 1.0, 3.7, 32.0}) {
    GaussianWeights(sigma, w);
    double sum = w[0];
    for (size_t k = 1; k < w.size(); ++k) sum += 2 * w[k];
    EXPECT_NEAR(sum, 1, 1e-14) << sigma;
    for (size_t k = 1; k < w.size(); ++k)  // recurrence over up to 193 weights: 1e-13 of the ratio
      EXPECT_NEAR(w[k] / w[0], std::exp(-0.5 * k * k / (sigma * sigma)), 1e-12) << sigma << " " << k;
  }
  GaussianWeights(0, w);
  EXPECT_EQ(w, std::vector<double>{1});
}

// An impulse under constant sigma gives the Gaussian itself, and keeps its energy to 1e-5.
TEST(ExactBlur, OfAnImpulseIsTheGaussian) {
  for (double sigma : {0.3, 0.8, 2.0, 5.0}) {
    const int border = GaussianRadius(sigma), size = 2 * border + 3;
    const cv::Mat out =
        ExactBlur(Impulse(size, border), border, cv::Mat(size, size, CV_32F, cv::Scalar(sigma)));
    double norm = 0;
    for (int k = -200; k <= 200; ++k) norm += std::exp(-0.5 * k * k / (sigma * sigma));
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const int dx = x - size / 2, dy = y - size / 2;
        // the result is a float32: 3e-8 near 1; sigma is one too
        EXPECT_NEAR(out.at<float>(y, x),
                    std::exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma)) / (norm * norm), 6e-8);
      }
    EXPECT_NEAR(cv::sum(out)[0], 1, 1e-5) << sigma;
  }
}

// Each pixel has its own kernel: brute force in two dimensions.
TEST(ExactBlur, EqualsBruteForceForVaryingSigma) {
  const int border = GaussianRadius(3), width = 19, height = 7;
  for (int channels : {1, 3}) {
    const cv::Mat frame = SinesPicture({width, height}, border, channels);
    cv::Mat sigma(height, width, CV_32F);
    noise::HashStream stream(0);
    for (int i = 0; i < width * height; ++i)
      sigma.at<float>(i) = static_cast<float>(3 * noise::UnitFromBits(stream.Next()));
    sigma.at<float>(0) = 0, sigma.at<float>(5) = 3;
    const cv::Mat out = ExactBlur(frame, border, sigma);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double s = sigma.at<float>(y, x);
        const int radius = GaussianRadius(s);
        for (int c = 0; c < channels; ++c) {
          double sum = 0, norm = 0;
          for (int j = -radius; j <= radius; ++j)
            for (int i = -radius; i <= radius; ++i) {
              const double w = s > 0 ? std::exp(-0.5 * (i * i + j * j) / (s * s)) : 1;
              sum += w * frame.ptr<float>(y + border + j)[(x + border + i) * channels + c], norm += w;
            }
          EXPECT_NEAR(out.ptr<float>(y)[x * channels + c], sum / norm, 1e-7);
        }
      }
  }
}

TEST(ExactBlur, IsTheIdentityAtSigma0AndContinuousThere) {
  const int border = 3;
  const cv::Mat frame = SinesPicture({17, 5}, border);
  const cv::Mat inside = frame(cv::Rect(border, border, 17, 5));
  EXPECT_TRUE(SameBytes(ExactBlur(frame, border, cv::Mat::zeros(5, 17, CV_32F)), inside));
  EXPECT_TRUE(SameBytes(ExactBlur(frame, border, cv::Mat(5, 17, CV_32F, cv::Scalar(1e-12))), inside));
  double last = 0;
  for (double sigma : {0.1, 0.2, 0.3, 0.4, 0.5}) {  // from nothing, and on
    const double change =
        cv::norm(ExactBlur(frame, border, cv::Mat(5, 17, CV_32F, cv::Scalar(sigma))), inside, cv::NORM_INF);
    EXPECT_GE(change, last);
    last = change;
  }
  EXPECT_GT(last, 1e-3);
  EXPECT_LT(
      cv::norm(ExactBlur(frame, border, cv::Mat(5, 17, CV_32F, cv::Scalar(0.15))), inside, cv::NORM_INF),
      1e-7);
}

TEST(ExactBlur, AConstantStaysConstant) {
  const int border = GaussianRadius(32);
  const cv::Mat frame(2 * border + 1, 2 * border + 3, CV_32FC3, cv::Scalar(0.2, 0.7, 1.0));
  const cv::Mat sigma = (cv::Mat_<float>(1, 3) << 0.01f, 7.7f, 32.f);
  EXPECT_LT(cv::norm(ExactBlur(frame, border, sigma), cv::Mat(1, 3, CV_32FC3, cv::Scalar(0.2, 0.7, 1.0)),
                     cv::NORM_INF),
            1e-6);
}

TEST(ExactBlur, IsTheSameOnEveryTarget) {
  const int border = GaussianRadius(2);
  const cv::Mat frame = SinesPicture({21, 3}, border), sigma(3, 21, CV_32F, cv::Scalar(1.7));
  cv::Mat first;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    const cv::Mat out = ExactBlur(frame, border, sigma);
    if (first.empty()) first = out;
    EXPECT_TRUE(SameBytes(out, first)) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(BlurStack, EqualsTheExactBlurAtItsLevels) {
  const double low = 0.5, high = 4;
  const int border = GaussianRadius(high);
  const cv::Mat frame = SinesPicture({23, 11}, border);
  const BlurStack stack(frame, low, high);
  for (LevelChoice choice : {LevelChoice::kNearest, LevelChoice::kLinear})
    for (int level = 0; level < kStackLevels; ++level) {
      const cv::Mat sigma(11, 23, CV_32F, cv::Scalar(stack.sigma_px(level)));
      const cv::Mat exact = ExactBlur(frame, border, sigma);
      cv::Mat out(11, 23, CV_32FC3);
      for (int y = 0; y < 11; ++y) stack.Row({0, y}, {sigma.ptr<float>(y), 23}, choice, out.ptr<float>(y));
      EXPECT_LT(cv::norm(out, exact, cv::NORM_INF), 1e-6)
          << level;  // one rounding to float32 between rows and columns
    }
}

TEST(BlurStack, LevelsEndAtTheMaximum) {
  for (int i = 1; i <= 300; ++i)
    for (double low : {0.03, 0.06, 0.11, 0.22}) {
      const double high = std::max(low, i / 30.0);
      const int border = GaussianRadius(high);
      const BlurStack stack(cv::Mat(2 * border + 1, 2 * border + 1, CV_32F, cv::Scalar(1)), low, high);
      EXPECT_LE(stack.sigma_px(kStackLevels - 1), high);
      EXPECT_NEAR(stack.sigma_px(kStackLevels - 1), high, 1e-12);
    }
}

TEST(BlurStack, ReadsBetweenLevelsAsToldAndClampsOutside) {
  const int border = GaussianRadius(10);
  const BlurStack stack(Impulse(9, border), 0, 10);
  const auto centre = [&](float sigma, LevelChoice choice) {
    float out;
    stack.Row({4, 4}, {&sigma, 1}, choice, &out);
    return out;
  };
  EXPECT_EQ(centre(0, LevelChoice::kNearest), 1);
  EXPECT_EQ(centre(0.49f, LevelChoice::kNearest), 1);
  EXPECT_EQ(centre(0.51f, LevelChoice::kNearest), centre(1, LevelChoice::kNearest));
  EXPECT_NEAR(centre(0.25f, LevelChoice::kLinear),
              0.75 * centre(0, LevelChoice::kLinear) + 0.25 * centre(1, LevelChoice::kLinear), 1e-7);
  EXPECT_EQ(centre(10.1f, LevelChoice::kLinear), centre(10, LevelChoice::kLinear));
}

}  // namespace
}  // namespace shimmer::sim
