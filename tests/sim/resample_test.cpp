// Parts of resized pictures, against the exact sums, cv::resize of the whole, and one another.
#include "sim/resample.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>
#include <stdexcept>
#include <vector>

#include "sim/crop.h"
#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

cv::Mat RandomSamples(cv::Size size, int depth, int channels, uint32_t seed) {
  std::mt19937 generator(seed);
  const int top = depth == CV_8U ? 255 : 65535;
  cv::Mat_<double> values(size.height, size.width * channels);
  for (double& value : values) value = std::uniform_int_distribution<int>(0, top)(generator);
  cv::Mat samples;
  values.convertTo(samples, depth, depth == CV_32F ? 1.0 / top : 1);
  return samples.reshape(channels);
}

// Samples as the light they mean, in double.
cv::Mat LightOf(const cv::Mat& samples) {
  cv::Mat light;
  samples.convertTo(light, CV_64F,
                    samples.depth() == CV_8U    ? 1.0 / 255
                    : samples.depth() == CV_16U ? 1.0 / 65535
                                                : 1);
  return light;
}

// Keys' kernel, a = -0.75, at a distance.
double Keys(double distance) {
  const double a = -0.75, d = std::abs(distance);
  if (d <= 1) return (a + 2) * d * d * d - (a + 3) * d * d + 1;
  return d < 2 ? a * (d * d * d - 5 * d * d + 8 * d - 4) : 0;
}

// Weight of every sample (a row each pixel), from the definitions: the share of the pixel that the sample
// covers, or the kernel at the pixel's centre, samples beyond the edge being the edge's.
cv::Mat_<double> Weights(int size, int resized) {
  cv::Mat_<double> weights = cv::Mat_<double>::zeros(resized, size);
  const double step = static_cast<double>(size) / resized;
  for (int pixel = 0; pixel < resized; ++pixel) {
    if (resized <= size) {
      for (int i = 0; i < size; ++i)
        weights(pixel, i) =
            std::max(0.0, std::min(i + 1.0, (pixel + 1) * step) - std::max<double>(i, pixel * step)) / step;
    } else {
      const double centre = (pixel + 0.5) * step - 0.5;
      for (int i = -3; i < size + 3; ++i) weights(pixel, std::clamp(i, 0, size - 1)) += Keys(i - centre);
    }
  }
  return weights;
}

// The twin in double: rows and columns of weights times the picture, a channel at a time.
cv::Mat ExactResized(const cv::Mat& samples, cv::Size resized) {
  std::vector<cv::Mat> channels;
  cv::split(LightOf(samples), channels);
  for (cv::Mat& channel : channels)
    channel = Weights(samples.rows, resized.height) * channel * Weights(samples.cols, resized.width).t();
  cv::Mat merged;
  cv::merge(channels, merged);
  return merged;
}

double MostDifference(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat other;
  b.convertTo(other, CV_64F);
  cv::Mat one;
  a.convertTo(one, CV_64F);
  return cv::norm(one, other, cv::NORM_INF);
}

cv::Mat ResizedWhole(const cv::Mat& samples, cv::Size resized) {
  return ResizedPart(samples, resized, {{}, resized});
}

cv::Size Scaled(cv::Size size, double scale) {
  return {std::max(1, static_cast<int>(std::lround(size.width * scale))),
          std::max(1, static_cast<int>(std::lround(size.height * scale)))};
}

// Odd, tiny, long and ordinary sizes at scales over the whole range, the sizes that come of them within
// reason.
template <class F>
void ForManyGeometries(const F& f) {
  const cv::Size sizes[] = {{1, 1},   {2, 1},    {1, 7},   {3, 5},    {17, 13},
                            {64, 48}, {101, 37}, {500, 3}, {333, 251}};
  const double scales[] = {0.01, 0.03,  0.1, 0.25, 0.3, 1 / 3.0, 0.37, 0.5, 0.501, 0.77, 0.9,
                           0.99, 0.999, 1,   1.01, 1.3, 1.5,     2,    2.5, 3.7,   7.9,  16};
  int tried = 0;
  for (const cv::Size size : sizes)
    for (const double scale : scales) {
      const cv::Size resized = Scaled(size, scale);
      if (resized.area() > 400'000) continue;
      SCOPED_TRACE(testing::Message() << size << " to " << resized);
      f(size, resized, tried++);
    }
  EXPECT_GT(tried, 150);
}

// Sums are in double; between the axes and at the end a value is rounded to float, by half a unit of its last
// place: 2^-24 for values up to 2. Between the axes there are up to 1.375 of them, as bicubic weights may add
// up to in magnitude.
constexpr double kRounding = 1.5e-7;

TEST(ResizedPart, IsTheExactSum) {
  ForManyGeometries([](cv::Size size, cv::Size resized, int i) {
    const int depth = std::array{CV_8U, CV_16U, CV_32F}[i % 3];
    const cv::Mat samples = RandomSamples(size, depth, i % 2 == 0 ? 3 : 1, i),
                  part = ResizedWhole(samples, resized);
    ASSERT_EQ(part.type(), CV_32FC(samples.channels()));
    ASSERT_EQ(part.size(), resized);
    EXPECT_LE(MostDifference(part, ExactResized(samples, resized)), kRounding);
  });
}

// OpenCV leaves out what a pixel covers of a sample where that is below 1/1000 of the sample.
double LeftOutByOpenCv(int size, int resized) {
  if (resized >= size) return 0;
  const double step = static_cast<double>(size) / resized;
  double most = 0;
  for (int pixel = 0; pixel < resized; ++pixel) {
    const double begin = std::ceil(pixel * step) - pixel * step,
                 end = (pixel + 1) * step - std::floor((pixel + 1) * step);
    most = std::max(most, (begin <= 1e-3 + 1e-9 ? begin : 0) + (end <= 1e-3 + 1e-9 ? end : 0));
  }
  return most / step;
}

// Its bicubic places are floats: off by half a unit of their last place, and four weights change by less than
// 4 together a sample.
double MisplacedByOpenCv(int size, int resized) { return resized > size ? 4 * std::ldexp(size, -24) : 0; }

TEST(ResizedPart, IsWhatOpenCvMakesOfTheWhole) {
  ForManyGeometries([](cv::Size size, cv::Size resized, int i) {
    const cv::Mat picture = RandomSamples(size, CV_32F, i % 2 == 0 ? 3 : 1, i);
    const bool shrinks = resized.width <= size.width && resized.height <= size.height;
    cv::Mat theirs;
    cv::resize(picture, theirs, resized, 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_CUBIC);
    const double summed_in_float =
        std::ldexp(8.0 + size.width / resized.width + size.height / resized.height, -24);
    const double tolerance = summed_in_float + LeftOutByOpenCv(size.width, resized.width) +
                             LeftOutByOpenCv(size.height, resized.height) +
                             1.375 * (MisplacedByOpenCv(size.width, resized.width) +
                                      MisplacedByOpenCv(size.height, resized.height));
    EXPECT_LE(MostDifference(ResizedWhole(picture, resized), theirs), tolerance);
  });
}

TEST(ResizedPart, HasTheBitsOfTheWhole) {
  std::mt19937 generator(1);
  ForManyGeometries([&](cv::Size size, cv::Size resized, int i) {
    const cv::Mat samples =
        RandomSamples(size, std::array{CV_8U, CV_16U, CV_32F}[i % 3], i % 2 == 0 ? 3 : 1, i);
    const cv::Mat whole = ResizedWhole(samples, resized);
    const auto random = [&](int low, int high) {
      return std::uniform_int_distribution(low, high)(generator);
    };
    for (int n = 0; n < 5; ++n) {
      const int x = random(0, resized.width - 1), y = random(0, resized.height - 1);
      const cv::Rect part(x, y, random(1, resized.width - x), random(1, resized.height - y));
      EXPECT_TRUE(SameBytes(ResizedPart(samples, resized, part), whole(part))) << part;
    }
  });
}

TEST(ResizedPart, HasTheSameBitsOnEveryTarget) {
  const auto all = [] {
    std::vector<cv::Mat> all;
    for (const int depth : {CV_8U, CV_16U, CV_32F})
      for (const cv::Size resized : {cv::Size(31, 22), cv::Size(150, 97)})
        all.push_back(ResizedWhole(RandomSamples({101, 77}, depth, 3, 1), resized));
    return all;
  };
  const std::vector<cv::Mat> best = all();
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    EXPECT_TRUE(std::ranges::equal(all(), best, SameBytes)) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(ResizedPart, ReadsPicturesThatArePartsOfOthers) {
  const cv::Mat picture = RandomSamples({50, 40}, CV_8U, 3, 1), part = picture({7, 5, 31, 23});
  EXPECT_TRUE(SameBytes(ResizedWhole(part, {11, 9}), ResizedWhole(part.clone(), {11, 9})));
}

// Nothing to resize: the samples as light, to the last bit.
TEST(ResizedPart, OfTheSameSizeIsThePicture) {
  cv::Mat every(1, 65536, CV_16U);
  for (int v = 0; v < 65536; ++v) every.at<uint16_t>(v) = static_cast<uint16_t>(v);
  const cv::Mat sixteen = ResizedWhole(every, every.size());
  for (int v = 0; v < 65536; ++v) ASSERT_EQ(sixteen.at<float>(v), static_cast<float>(v) / 65535.f) << v;
  every.colRange(0, 256).convertTo(every, CV_8U);
  const cv::Mat eight = ResizedWhole(every, every.size());
  for (int v = 0; v < 256; ++v) ASSERT_EQ(eight.at<float>(v), static_cast<float>(v) / 255.f) << v;
  const cv::Mat floats = RandomSamples({31, 17}, CV_32F, 3, 1);
  EXPECT_TRUE(SameBytes(ResizedWhole(floats, floats.size()), floats));
}

TEST(ResizedPart, ConstantsStayConstant) {
  ForManyGeometries([](cv::Size size, cv::Size resized, int i) {
    const double value = (i * 37 % 254 + 1) / 255.0;
    const cv::Mat constant(size, CV_32FC3, cv::Scalar::all(value));
    EXPECT_LE(
        MostDifference(ResizedWhole(constant, resized), cv::Mat(resized, CV_64FC3, cv::Scalar::all(value))),
        2e-7);
  });
}

// Every sample has the same weight in all pixels together.
TEST(ResizedPart, ShrinkingKeepsTheMean) {
  ForManyGeometries([](cv::Size size, cv::Size resized, int i) {
    if (resized.width > size.width || resized.height > size.height) return;
    const cv::Mat picture = RandomSamples(size, CV_32F, 1, i);
    EXPECT_NEAR(cv::mean(ResizedWhole(picture, resized))[0], cv::mean(picture)[0], 2e-7);
  });
}

// One axis may shrink and the other grow.
TEST(ResizedPart, EachAxisByItself) {
  const cv::Mat picture = RandomSamples({40, 9}, CV_16U, 3, 1);
  EXPECT_LE(MostDifference(ResizedWhole(picture, {13, 20}), ExactResized(picture, {13, 20})), kRounding);
}

TEST(ResizedPart, LargestSamplesStayInBounds) {
  const cv::Mat picture(20, 20, CV_32F, cv::Scalar(65504));
  for (const int side : {3, 20, 75})
    EXPECT_LE(
        MostDifference(ResizedWhole(picture, {side, side}), cv::Mat(side, side, CV_64F, cv::Scalar(65504))),
        65504 * 2e-7);
}

TEST(ResizedPart, RefusesWhatItCantResize) {
  const cv::Mat picture = RandomSamples({8, 6}, CV_8U, 3, 1);
  EXPECT_THROW(ResizedPart({}, {4, 4}, {0, 0, 1, 1}), std::invalid_argument);
  EXPECT_THROW(ResizedPart(cv::Mat(4, 4, CV_8UC2), {4, 4}, {0, 0, 1, 1}), std::invalid_argument);
  EXPECT_THROW(ResizedPart(cv::Mat(4, 4, CV_64F), {4, 4}, {0, 0, 1, 1}), std::invalid_argument);
  EXPECT_THROW(ResizedPart(picture, {0, 4}, {0, 0, 1, 1}), std::invalid_argument);
  for (const cv::Rect part :
       {cv::Rect(0, 0, 0, 1), cv::Rect(-1, 0, 2, 2), cv::Rect(3, 0, 2, 2), cv::Rect(0, 4, 1, 1)})
    EXPECT_THROW(ResizedPart(picture, {4, 4}, part), std::invalid_argument) << part;
}

// Resized, then cropped, as one: also where the halo is wider than the crop, or than the picture.
TEST(ResizedCropWithHalo, IsTheCropOfTheResized) {
  const cv::Mat samples = RandomSamples({60, 50}, CV_8U, 3, 1);
  for (const cv::Size resized : {cv::Size(60, 50), cv::Size(21, 17), cv::Size(90, 75), cv::Size(1, 1)}) {
    const cv::Mat whole = ResizedWhole(samples, resized);
    for (const int x : {0, 3, resized.width - 5})
      for (const int y : {0, 2, resized.height - 4})
        for (const int halo_px : {0, 1, 4, 15, 40, 200}) {
          const cv::Rect area = cv::Rect(x, y, 5, 4) & cv::Rect({}, resized);
          if (area.empty()) continue;
          EXPECT_TRUE(SameBytes(ResizedCropWithHalo(samples, resized, area, halo_px),
                                CropWithHalo(whole, area, halo_px)))
              << resized << area << halo_px;
        }
  }
}

}  // namespace
}  // namespace shimmer::sim
