#include "sim/colour.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <cmath>
#include <vector>

namespace shimmer::sim {
namespace {

double DecodeDouble(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }
double EncodeDouble(double v) {
  v = std::max(v, 0.0);
  return v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

// [-1, 2] densely, and up to the largest half float by equal ratios.
std::vector<float> Samples() {
  std::vector<float> samples;
  for (int i = 0; i < 200001; ++i) samples.push_back(static_cast<float>(-1 + i * 1.5e-5));
  for (double v = 1e-7; v < 65504; v *= 1.0003) samples.push_back(static_cast<float>(v));
  samples.insert(samples.end(), {0.04045f, std::nextafter(0.04045f, 1.0f), 0.0031308f,
                                 std::nextafter(0.0031308f, 1.0f), 0.0f, -0.0f, 1.0f, 65504.0f, -65504.0f});
  return samples;
}

struct Transfer {
  void (*row)(std::span<float>);
  double (*twin)(double);
};
const Transfer kTransfers[] = {{DecodeSrgbRow, DecodeDouble}, {EncodeSrgbRow, EncodeDouble}};

TEST(SrgbRow, IsWithinItsErrorOfTheStandard) {
  for (const Transfer& transfer : kTransfers) {
    const std::vector<float> samples = Samples();
    std::vector<float> mapped = samples;
    transfer.row(mapped);
    for (size_t i = 0; i < samples.size(); ++i) {
      const double twin = transfer.twin(samples[i]);
      ASSERT_NEAR(mapped[i], twin, 1e-6 * std::max(1.0, std::abs(twin))) << samples[i];
    }
  }
}

// Between neighbours of the ramp, the knee included, nothing goes back by more than the rounding of the
// result.
TEST(SrgbRow, Rises) {
  for (const Transfer& transfer : kTransfers) {
    std::vector<float> ramp(200001);
    for (size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<float>(i) / 200000;
    transfer.row(ramp);
    for (size_t i = 1; i < ramp.size(); ++i) ASSERT_GE(ramp[i], ramp[i - 1] - 2e-7f) << i;
  }
}

TEST(SrgbRow, EndsStayAndNegativeLightIsBlack) {
  std::vector<float> samples{0.0f, 1.0f};
  DecodeSrgbRow(samples);
  EXPECT_EQ(samples[0], 0.0f);
  EXPECT_NEAR(samples[1], 1.0f, 2e-7f);
  samples = {-0.1f, -1e-30f, -1e30f};
  EncodeSrgbRow(samples);
  for (const float v : samples) EXPECT_EQ(v, 0.0f);
}

TEST(SrgbRow, IsTheSameOnEveryTargetAndAtEveryWidth) {
  for (const Transfer& transfer : kTransfers) {
    std::vector<float> first;
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      std::vector<float> whole = Samples();
      transfer.row(whole);
      if (first.empty()) first = whole;
      EXPECT_EQ(whole, first) << hwy::TargetName(target);
      for (const size_t width : {0, 1, 3, 17}) {
        std::vector<float> part = Samples();
        transfer.row(std::span(part).subspan(100001, width));
        for (size_t i = 0; i < width; ++i) EXPECT_EQ(part[100001 + i], first[100001 + i]);
        EXPECT_EQ(part[100001 + width], Samples()[100001 + width]);
      }
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}

TEST(Srgb, ImagesAreMappedRowByRow) {
  cv::Mat image(3, 5, CV_32FC3);
  image.forEach<cv::Vec3f>([&](cv::Vec3f& pixel, const int*) { pixel = {0.1f, 0.5f, 0.9f}; });
  const cv::Mat part = image(cv::Rect(1, 1, 3, 2)), light = DecodeSrgb(part), back = EncodeSrgb(light);
  for (int y = 0; y < part.rows; ++y)
    for (int i = 0; i < part.cols * 3; ++i) {
      EXPECT_NEAR(light.ptr<float>(y)[i], DecodeDouble(part.ptr<float>(y)[i]), 1e-6);
      EXPECT_NEAR(back.ptr<float>(y)[i], part.ptr<float>(y)[i], 1e-6);
    }
  EXPECT_EQ(image.at<cv::Vec3f>(1, 1)[1], 0.5f);  // the argument stays
}

}  // namespace
}  // namespace shimmer::sim
