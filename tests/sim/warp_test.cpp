#include "sim/warp.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <vector>

#include "noise/hash.h"
#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

constexpr int kHalo = 10;

class Warp : public testing::TestWithParam<std::tuple<Interpolation, int>> {
 protected:
  Interpolation interpolation() const { return std::get<0>(GetParam()); }
  int channels() const { return std::get<1>(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(All, Warp,
                         testing::Combine(testing::Values(Interpolation::kNearest, Interpolation::kBilinear,
                                                          Interpolation::kBicubic),
                                          testing::Values(1, 3)));

// float32 against double on the same weights: 16 products below 1.3, each with relative error 6e-8 or so.
TEST_P(Warp, EqualsItsDoubleTwin) {
  const cv::Mat frame = SinesPicture({37, 23}, kHalo, channels());
  noise::HashStream stream(0);
  std::vector<float> dx(37), dy(37), out(37 * channels());
  for (int y = 0; y < 23; ++y) {
    for (float& d : dx) d = static_cast<float>(noise::UnitFromBits(stream.Next()) * 16 - 8);
    for (float& d : dy) d = static_cast<float>(noise::UnitFromBits(stream.Next()) * 16 - 8);
    WarpRow(frame, {kHalo, y + kHalo}, dx, dy, interpolation(), out.data());
    for (int x = 0; x < 37; ++x)
      for (int c = 0; c < channels(); ++c)
        EXPECT_NEAR(
            out[x * channels() + c],
            WarpDouble(frame, x + kHalo + double{dx[x]}, y + kHalo + double{dy[x]}, c, interpolation()),
            1e-6);
  }
}

TEST_P(Warp, WholePixelsAreCopied) {
  const cv::Mat frame = SinesPicture({9, 1}, kHalo, channels());
  const std::vector<float> dx{0, 1, -1, 5, -5, 0, 0, 3, -8}, dy{0, 0, 0, 0, 0, 7, -7, -3, 8};
  std::vector<float> out(9 * channels());
  WarpRow(frame, {kHalo, kHalo}, dx, dy, interpolation(), out.data());
  for (int x = 0; x < 9; ++x)
    for (int c = 0; c < channels(); ++c)
      EXPECT_EQ(out[x * channels() + c],
                frame.ptr<float>(
                    kHalo + static_cast<int>(dy[x]))[(kHalo + x + static_cast<int>(dx[x])) * channels() + c]);
}

TEST_P(Warp, AConstantStaysConstant) {
  const cv::Mat frame(21, 40, CV_32FC(channels()), cv::Scalar::all(0.7));
  std::vector<float> dx(20), dy(20), out(20 * channels());
  for (int x = 0; x < 20; ++x) dx[x] = 0.05f * x - 0.5f, dy[x] = 0.07f * x;
  WarpRow(frame, {kHalo, kHalo}, dx, dy, interpolation(), out.data());
  for (float v : out) EXPECT_NEAR(v, 0.7f, 3e-7f);
}

TEST_P(Warp, IsTheSameOnEveryTarget) {
  const cv::Mat frame = SinesPicture({37, 3}, kHalo, channels());
  std::vector<float> dx(37), dy(37), out(37 * channels()), first;
  for (int x = 0; x < 37; ++x) dx[x] = 0.37f * x - 7, dy[x] = 5 - 0.29f * x;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    WarpRow(frame, {kHalo, kHalo + 1}, dx, dy, interpolation(), out.data());
    if (first.empty()) first = out;
    EXPECT_EQ(out, first) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

// What each interpolation loses on the analytic picture: against the function itself. Curvature there is
// below 0.05 a px^2, so bilinear loses at most 0.05 / 8 an axis, and Catmull-Rom far less; nearest loses half
// a slope of 0.1.
TEST(WarpAccuracy, ApproachesTheAnalyticPicture) {
  const cv::Mat frame = SinesPicture({64, 64}, kHalo);
  const auto worst = [&](Interpolation interpolation) {
    double error = 0;
    std::vector<float> dx(64), dy(64), out(64 * 3);
    noise::HashStream stream(1);
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x)
        dx[x] = static_cast<float>(noise::UnitFromBits(stream.Next()) * 8 - 4),
        dy[x] = static_cast<float>(noise::UnitFromBits(stream.Next()) * 8 - 4);
      WarpRow(frame, {kHalo, y + kHalo}, dx, dy, interpolation, out.data());
      for (int x = 0; x < 64; ++x)
        error =
            std::max(error, std::abs(out[3 * x + 1] - SumOfSines(x + double{dx[x]}, y + double{dy[x]}, 1)));
    }
    return error;
  };
  EXPECT_LT(worst(Interpolation::kBicubic), 0.0015);
  EXPECT_LT(worst(Interpolation::kBilinear), 0.0125);
  EXPECT_LT(worst(Interpolation::kNearest), 0.13);
  EXPECT_GT(worst(Interpolation::kNearest), 0.04);  // half a pixel is half a pixel
}

}  // namespace
}  // namespace shimmer::sim
