#include "sim/pack_rows.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "noise/hash.h"

namespace shimmer::sim {
namespace {

// What sim/dataset/samples.cpp writes: the exact product in double, rounded in the machine's mode.
template <class T>
T SampleOf(float v) {
  const double clamped = v > 0 ? (v < 1 ? v : 1) : 0;
  return static_cast<T>(std::nearbyint(clamped * std::numeric_limits<T>::max()));
}

template <class T>
std::vector<T> Packed(const std::vector<float>& plane) {
  std::vector<T> samples(plane.size());
  PackRow(std::array<const float*, 1>{plane.data()}, 1, plane.size(), samples.data());
  return samples;
}

float FromBits(uint32_t bits) {
  float v;
  std::memcpy(&v, &bits, sizeof v);
  return v;
}

// The floats around every boundary between two samples, where alone rounding can go wrong.
template <class T>
std::vector<float> AroundEveryTie() {
  std::vector<float> values;
  for (int k = 0; k < std::numeric_limits<T>::max(); ++k) {
    float v = static_cast<float>((k + 0.5) / std::numeric_limits<T>::max());
    for (int i = 0; i < 4; ++i) v = std::nextafter(v, 0.0f);
    for (int i = 0; i < 9; ++i, v = std::nextafter(v, 2.0f)) values.push_back(v);
  }
  return values;
}

std::vector<float> RandomAndOddFloats() {
  const float infinity = std::numeric_limits<float>::infinity(),
              nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> values{0.0f,
                            -0.0f,
                            1.0f,
                            0.5f,
                            -1.0f,
                            1e38f,
                            -1e38f,
                            1e-45f,
                            -infinity,
                            infinity,
                            nan,
                            -nan,
                            65504.0f,
                            1e-38f,
                            std::nextafter(1.0f, 0.0f),
                            std::nextafter(1.0f, 2.0f)};
  noise::HashStream stream(0);
  for (int i = 0; i < 300000; ++i) values.push_back(static_cast<float>(noise::UnitFromBits(stream.Next())));
  for (int i = 0; i < 300000; ++i) values.push_back(FromBits(static_cast<uint32_t>(stream.Next())));
  return values;
}

template <class T>
class PackWhole : public testing::Test {};
using WholeTypes = testing::Types<uint8_t, uint16_t>;
TYPED_TEST_SUITE(PackWhole, WholeTypes);

TYPED_TEST(PackWhole, RoundsExactlyOnEveryTarget) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (const auto& values : {AroundEveryTie<TypeParam>(), RandomAndOddFloats()}) {
      const std::vector<TypeParam> samples = Packed<TypeParam>(values);
      for (size_t i = 0; i < values.size(); ++i)
        ASSERT_EQ(samples[i], SampleOf<TypeParam>(values[i]))
            << hwy::TargetName(target) << ", " << std::hexfloat << values[i];
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

// The float nearest to v / top for every v, and back.
TYPED_TEST(PackWhole, UnpacksEverySampleExactlyOnEveryTarget) {
  constexpr int kTop = std::numeric_limits<TypeParam>::max();
  cv::Mat_<TypeParam> all(1, kTop + 1);
  for (int v = 0; v <= kTop; ++v) all(0, v) = static_cast<TypeParam>(v);
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    std::vector<float> plane(kTop + 1);
    float* const planes[] = {plane.data()};
    UnpackRow(all, {0, 0}, plane.size(), planes);
    for (int v = 0; v <= kTop; ++v) ASSERT_EQ(plane[v], v / float{kTop}) << v;
    EXPECT_TRUE(std::equal(all.begin(), all.end(), Packed<TypeParam>(plane).begin()));
  }
  hwy::SetSupportedTargetsForTest(0);
}

template <class T>
class PackRows : public testing::Test {};
using AllTypes = testing::Types<uint8_t, uint16_t, float>;
TYPED_TEST_SUITE(PackRows, AllTypes);

// Pixel by pixel, at every odd width, writing nothing beyond the end; and from the middle of a frame back.
TYPED_TEST(PackRows, PutsChannelsInTheirPlaces) {
  constexpr float kTop = std::is_same_v<TypeParam, float> ? 1 : std::numeric_limits<TypeParam>::max();
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (const int channels : {1, 3})
      for (const int width : {1, 2, 3, 15, 16, 17, 63, 64, 65}) {
        std::vector<std::vector<float>> planes(channels, std::vector<float>(width)),
            back(channels, std::vector<float>(width + 1, -7));
        std::vector<const float*> from;
        std::vector<float*> to;
        for (int c = 0; c < channels; ++c) {
          for (int i = 0; i < width; ++i) planes[c][i] = static_cast<float>(i * 3 + c) / kTop;
          from.push_back(planes[c].data());
          to.push_back(back[c].data());
        }
        cv::Mat frame(3, width + 2, CV_MAKETYPE(cv::DataType<TypeParam>::depth, channels),
                      cv::Scalar::all(9));
        TypeParam* row = frame.ptr<TypeParam>(1) + channels;
        PackRow(from, channels, width, row);
        for (int i = 0; i < width * channels; ++i) ASSERT_EQ(row[i], i % channels + i / channels * 3);
        for (int c = -channels; c < 0; ++c) EXPECT_EQ(row[c], 9);
        for (int c = 0; c < channels; ++c) EXPECT_EQ(row[width * channels + c], 9);
        UnpackRow(frame, {1, 1}, width, to.data());
        for (int c = 0; c < channels; ++c) {
          EXPECT_EQ(back[c].back(), -7);
          back[c].pop_back();
          EXPECT_EQ(back[c], planes[c]) << hwy::TargetName(target) << " " << width;
        }
      }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TYPED_TEST(PackRows, OnePlaneMakesThreeEqualChannels) {
  std::vector<float> plane(37);
  for (size_t i = 0; i < plane.size(); ++i) plane[i] = static_cast<float>(i) / 36;
  std::vector<TypeParam> one(plane.size()), three(3 * plane.size());
  const std::array<const float*, 1> planes{plane.data()};
  PackRow(planes, 1, plane.size(), one.data());
  PackRow(planes, 3, plane.size(), three.data());
  for (size_t i = 0; i < three.size(); ++i) EXPECT_EQ(three[i], one[i / 3]);
}

TEST(PackRows, RefuseOtherShapes) {
  std::vector<float> plane(4);
  std::vector<uint8_t> samples(12);
  const auto pack = [&](size_t planes, int channels) {
    PackRow(std::vector<const float*>(planes, plane.data()), channels, 4, samples.data());
  };
  EXPECT_THROW(pack(3, 1), std::invalid_argument);
  EXPECT_THROW(pack(2, 2), std::invalid_argument);
  EXPECT_THROW(pack(0, 1), std::invalid_argument);
  float* const planes[] = {plane.data(), plane.data(), plane.data(), plane.data()};
  EXPECT_THROW(UnpackRow(cv::Mat(1, 4, CV_8UC4, cv::Scalar(0)), {0, 0}, 4, planes), std::invalid_argument);
  EXPECT_THROW(UnpackRow(cv::Mat(1, 4, CV_64FC1, cv::Scalar(0)), {0, 0}, 4, planes), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::sim
