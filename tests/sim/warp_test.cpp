#include "sim/warp.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <limits>
#include <vector>

#include "noise/hash.h"
#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

constexpr int kHalo = 70;  // 64 px of shift, and the reach
constexpr Interpolation kInterpolations[] = {Interpolation::kNearest, Interpolation::kBilinear,
                                             Interpolation::kBicubic};

using Planes = std::vector<std::vector<float>>;

struct Shifts {
  std::vector<float> dx, dy;
};

Shifts RandomShifts(size_t count, double largest_px, uint64_t seed = 0) {
  noise::HashStream stream(seed);
  Shifts shifts{std::vector<float>(count), std::vector<float>(count)};
  const auto random = [&] {
    return static_cast<float>((noise::UnitFromBits(stream.Next()) * 2 - 1) * largest_px);
  };
  for (float& d : shifts.dx) d = random();
  for (float& d : shifts.dy) d = random();
  return shifts;
}

double TopOf(int type) {
  return CV_MAT_DEPTH(type) == CV_8U ? 255 : CV_MAT_DEPTH(type) == CV_16U ? 65535 : 1;
}

// Every sample random: as far from smooth as a picture can be.
cv::Mat NoisePicture(cv::Size size, int type) {
  noise::HashStream stream(1);
  cv::Mat picture = Picture(size, kHalo, CV_MAT_CN(type),
                            [&](int, int, int) { return noise::UnitFromBits(stream.Next()) * TopOf(type); });
  picture.convertTo(picture, type);
  return picture;
}

// Row y of the picture within the halo; what lies beyond the planes' ends must stay as it was.
Planes Warped(const cv::Mat& clean, int y, const Shifts& shifts, Interpolation interpolation) {
  constexpr float kUntouched = -7;
  const size_t width = shifts.dx.size();
  Planes planes(clean.channels(), std::vector<float>(width + 1, kUntouched));
  std::vector<float*> pointers;
  for (auto& plane : planes) pointers.push_back(plane.data());
  WarpRow(PrepareForWarp(clean), {kHalo, y + kHalo}, shifts.dx, shifts.dy, interpolation, pointers.data());
  for (auto& plane : planes) {
    EXPECT_EQ(plane.back(), kUntouched);
    plane.pop_back();
  }
  return planes;
}

class Warp : public testing::TestWithParam<std::tuple<Interpolation, int>> {
 protected:
  Interpolation interpolation() const { return std::get<0>(GetParam()); }
  int type() const { return std::get<1>(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(All, Warp,
                         testing::Combine(testing::ValuesIn(kInterpolations),
                                          testing::Values(CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3, CV_32FC1,
                                                          CV_32FC3)));

// float32 against double: 16 products, the sum of whose absolute weights is at most 1.6, a few roundings of
// 6e-8 each. On noise, where nothing cancels by smoothness; a nearest pixel may differ only where the
// fraction is one half, which random shifts of 24 bits do not hit.
TEST_P(Warp, EqualsItsDoubleTwinOnNoise) {
  for (const double largest_px : {0.9, 64.0})
    for (const int width : {1, 2, 17, 63, 64, 65, 130}) {
      const cv::Mat clean = NoisePicture({width, 3}, type());
      for (int y = 0; y < 3; ++y) {
        const Shifts shifts = RandomShifts(width, largest_px, y);
        const Planes planes = Warped(clean, y, shifts, interpolation());
        for (int x = 0; x < width; ++x)
          for (int c = 0; c < clean.channels(); ++c)
            ASSERT_NEAR(planes[c][x],
                        WarpDouble(clean, x + kHalo + double{shifts.dx[x]}, y + kHalo + double{shifts.dy[x]},
                                   c, interpolation()),
                        1e-6)
                << "width " << width << ", pixel " << x;
      }
    }
}

// Exactly: weights of 0 and 1, and the float nearest to v / 255 or v / 65535.
TEST_P(Warp, WholePixelsAreCopied) {
  cv::Mat clean(1 + 2 * kHalo, 300 + 2 * kHalo, type());
  for (int y = 0; y < clean.rows; ++y)
    for (int i = 0; i < clean.cols * clean.channels(); ++i) {
      const double v = (i * 131 + y * 7919) % (static_cast<int>(TopOf(type())) + 1);
      if (clean.depth() == CV_8U) clean.ptr<uint8_t>(y)[i] = static_cast<uint8_t>(v);
      if (clean.depth() == CV_16U) clean.ptr<uint16_t>(y)[i] = static_cast<uint16_t>(v);
      if (clean.depth() == CV_32F) clean.ptr<float>(y)[i] = static_cast<float>(0.1 * i - y);
    }
  Shifts shifts = RandomShifts(300, 64);
  for (float& d : shifts.dx) d = std::round(d);
  for (float& d : shifts.dy) d = std::round(d);
  const Planes planes = Warped(clean, 0, shifts, interpolation());
  for (int x = 0; x < 300; ++x)
    for (int c = 0; c < clean.channels(); ++c) {
      const int i = (x + kHalo + static_cast<int>(shifts.dx[x])) * clean.channels() + c,
                y = kHalo + static_cast<int>(shifts.dy[x]);
      const float expected = clean.depth() == CV_8U    ? clean.ptr<uint8_t>(y)[i] / 255.f
                             : clean.depth() == CV_16U ? clean.ptr<uint16_t>(y)[i] / 65535.f
                                                       : clean.ptr<float>(y)[i];
      ASSERT_EQ(planes[c][x], expected) << x;
    }
}

// The largest sample: weights that sum to one but for their rounding, twice.
TEST_P(Warp, AConstantStaysConstant) {
  const cv::Mat clean(20 + 2 * kHalo, 200 + 2 * kHalo, type(), cv::Scalar::all(TopOf(type())));
  for (const auto& plane : Warped(clean, 5, RandomShifts(200, 20), interpolation()))
    for (const float v : plane) EXPECT_NEAR(v, 1, 4e-7f);
}

TEST_P(Warp, IsTheSameOnEveryTarget) {
  const cv::Mat clean = NoisePicture({131, 1}, type());
  const Shifts shifts = RandomShifts(131, 64);
  Planes first;
  int targets = 0;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    const Planes planes = Warped(clean, 0, shifts, interpolation());
    if (targets++ == 0) first = planes;
    EXPECT_EQ(planes, first) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GE(targets, 2);
}

// A pixel's bits depend neither on where its row begins nor on how long it is.
TEST_P(Warp, ARowIsTheSameWhereverItBegins) {
  const cv::Mat clean = NoisePicture({200, 1}, type()), source = PrepareForWarp(clean);
  const Shifts shifts = RandomShifts(200, 64);
  const Planes whole = Warped(clean, 0, shifts, interpolation());
  for (const size_t start : {1, 63, 64, 100})
    for (const size_t width : {1, 7, 64, 99}) {
      Planes part(clean.channels(), std::vector<float>(width));
      std::vector<float*> pointers;
      for (auto& plane : part) pointers.push_back(plane.data());
      WarpRow(source, {kHalo + static_cast<int>(start), kHalo}, std::span(shifts.dx).subspan(start, width),
              std::span(shifts.dy).subspan(start, width), interpolation(), pointers.data());
      for (size_t c = 0; c < part.size(); ++c)
        for (size_t i = 0; i < width; ++i) ASSERT_EQ(part[c][i], whole[c][start + i]);
    }
}

// Grey, alone and as three equal channels, is the same picture.
TEST(WarpOfGrey, HasTheBitsOfEqualChannels) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (const int type : {CV_8UC1, CV_16UC1, CV_32FC1})
      for (const Interpolation interpolation : kInterpolations) {
        const cv::Mat grey = NoisePicture({131, 1}, type);
        cv::Mat colour;
        cv::merge(std::vector{grey, grey, grey}, colour);
        const Shifts shifts = RandomShifts(131, 64);
        const Planes one = Warped(grey, 0, shifts, interpolation),
                     three = Warped(colour, 0, shifts, interpolation);
        for (const auto& plane : three) EXPECT_EQ(plane, one[0]);
      }
  }
  hwy::SetSupportedTargetsForTest(0);
}

// Only what kWarpReachPx allows is read: the NaN beyond would spread.
TEST(WarpReach, IsEnough) {
  for (const int type : {CV_32FC1, CV_32FC3})
    for (const Interpolation interpolation : kInterpolations)
      for (const float d : {0.0f, 0.999f, -0.999f, 1.0f, -1.0f}) {
        const int margin = 1 + kWarpReachPx;  // ceil(|d|) + kWarpReachPx
        cv::Mat around(40, 40, type, cv::Scalar::all(std::numeric_limits<float>::quiet_NaN()));
        around(cv::Rect(9, 9, 17 + 2 * margin, 1 + 2 * margin)).setTo(0.5);
        const std::vector<float> shifts(17, d);
        Planes planes(around.channels(), std::vector<float>(17));
        std::vector<float*> pointers;
        for (auto& plane : planes) pointers.push_back(plane.data());
        WarpRow(PrepareForWarp(around), {9 + margin, 9 + margin}, shifts, shifts, interpolation,
                pointers.data());
        for (const auto& plane : planes)
          for (const float v : plane) EXPECT_NEAR(v, 0.5f, 3e-7f);
      }
}

// The promise on smooth pictures, from 8 bits on, in 1/255.
TEST(WarpAccuracy, OfSmoothPicturesIsFarBelowALevel) {
  cv::Mat clean = SinesPicture({200, 1}, kHalo);
  clean.convertTo(clean, CV_8U, 255);
  const Shifts shifts = RandomShifts(200, 8);
  const Planes planes = Warped(clean, 0, shifts, Interpolation::kBicubic);
  for (int x = 0; x < 200; ++x)
    EXPECT_NEAR(255 * planes[1][x],
                255 * WarpDouble(clean, x + kHalo + double{shifts.dx[x]}, kHalo + double{shifts.dy[x]}, 1,
                                 Interpolation::kBicubic),
                0.0003);
}

// What each interpolation loses on the analytic picture: against the function itself. Curvature there is
// below 0.05 a px^2, so bilinear loses at most 0.05 / 8 an axis, and Catmull-Rom far less; nearest loses half
// a slope of 0.1.
TEST(WarpAccuracy, ApproachesTheAnalyticPicture) {
  const cv::Mat clean = SinesPicture({64, 64}, kHalo);
  const auto worst = [&](Interpolation interpolation) {
    double error = 0;
    for (int y = 0; y < 64; ++y) {
      const Shifts shifts = RandomShifts(64, 4, y);
      const Planes planes = Warped(clean, y, shifts, interpolation);
      for (int x = 0; x < 64; ++x)
        error = std::max(error, std::abs(planes[1][x] -
                                         SumOfSines(x + double{shifts.dx[x]}, y + double{shifts.dy[x]}, 1)));
    }
    return error;
  };
  EXPECT_LT(worst(Interpolation::kBicubic), 0.0015);
  EXPECT_LT(worst(Interpolation::kBilinear), 0.0125);
  EXPECT_LT(worst(Interpolation::kNearest), 0.13);
  EXPECT_GT(worst(Interpolation::kNearest), 0.04);  // half a pixel is half a pixel
}

TEST(PrepareForWarp, KeepsTheSamples) {
  for (const int depth : {CV_8U, CV_16U, CV_32F}) {
    const cv::Mat grey = NoisePicture({5, 1}, CV_MAKETYPE(depth, 1)),
                  colour = NoisePicture({5, 1}, CV_MAKETYPE(depth, 3));
    EXPECT_TRUE(SameBytes(PrepareForWarp(grey), grey));
    const cv::Mat four = PrepareForWarp(colour);
    EXPECT_EQ(four.type(), CV_MAKETYPE(depth, 4));
    for (int c = 0; c < 3; ++c) {
      cv::Mat from, to;
      cv::extractChannel(colour, from, c);
      cv::extractChannel(four, to, c);
      EXPECT_TRUE(SameBytes(from, to));
    }
  }
}

TEST(PrepareForWarp, RefusesOtherTypes) {
  for (const int type : {CV_8UC2, CV_8UC4, CV_64FC1, CV_32SC3, CV_16FC3})
    EXPECT_THROW(PrepareForWarp(cv::Mat(4, 4, type, cv::Scalar(0))), std::invalid_argument);
  float plane[1], *planes[] = {plane, plane, plane}, shift[] = {0};
  EXPECT_THROW(
      WarpRow(cv::Mat(9, 9, CV_8UC3, cv::Scalar(0)), {4, 4}, shift, shift, Interpolation::kBicubic, planes),
      std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::sim
