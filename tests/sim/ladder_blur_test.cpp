// The fast blur against the exact one.
#include "sim/ladder_blur.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "noise/hash.h"
#include "sim/colour.h"
#include "sim/crop.h"
#include "sim/drawn/drawn.h"
#include "sim/exact_blur.h"
#include "sim/gaussian.h"
#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

std::span<const float> RowOf(const cv::Mat& map, int y) {
  return {map.ptr<float>(y), static_cast<size_t>(map.cols)};
}

// The part of image at corner, of sigma's size, blurred by either way; what lies around it is the image's
// own.
cv::Mat Fast(const cv::Mat& image, cv::Point corner, const cv::Mat& sigma, const LevelLadder& ladder) {
  const int margin = ladder.margin_px();
  const LadderBlur blur(CropWithHalo(image, {corner, sigma.size()}, margin), ladder);
  cv::Mat out(sigma.size(), image.type());
  for (int y = 0; y < sigma.rows; ++y) blur.Row({margin, y + margin}, RowOf(sigma, y), out.ptr<float>(y));
  return out;
}

cv::Mat Exact(const cv::Mat& image, cv::Point corner, const cv::Mat& sigma) {
  double most;
  cv::minMaxLoc(sigma, nullptr, &most);
  const int margin = GaussianRadius(most);
  const cv::Mat frame = CropWithHalo(image, {corner, sigma.size()}, margin);
  cv::Mat out(sigma.size(), image.type());
  for (int y = 0; y < sigma.rows; ++y)
    ExactBlurRow(frame, {margin, y + margin}, RowOf(sigma, y), out.ptr<float>(y));
  return out;
}

// In 1/255 of the range.
double Rms(const cv::Mat& a, const cv::Mat& b) {
  return 255 * cv::norm(a, b, cv::NORM_L2) / std::sqrt(static_cast<double>(a.total() * a.channels()));
}

// A map with every sigma from 0 to most, in waves of a few tens of px.
cv::Mat Waves(cv::Size size, double most) {
  cv::Mat sigma(size, CV_32F);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      sigma.at<float>(y, x) = static_cast<float>(most * 0.5 * (1 - std::cos(0.11 * x + 0.07 * y)));
  return sigma;
}

// The promise of the default budget: RMS of at most 0.1/255 on photographs, at every sigma from 0 to 32 px.
TEST(LadderBlur, IsWithinATenthOfALevelOnPhotographs) {
  const std::filesystem::path folder = SHIMMER_SHARED_DIR "/data/photos/kodak8";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "data/photos/kodak8 is not beside this checkout";
  const LevelLadder &ladder = LevelLadder::For(32), &to8 = LevelLadder::For(8), &to3 = LevelLadder::For(3);
  int photographs = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".png") continue;
    cv::Mat image;
    cv::imread(file.path()).convertTo(image, CV_32FC3, 1 / 255.0);
    ++photographs;
    const cv::Point corner(image.cols / 3, image.rows / 3);
    for (double s :
         {0.1, 0.24, 0.3, 0.4, 0.6, 0.87, 1.2, 1.7, 2.4, 3.5, 4.9, 6.9, 9.8, 14.0, 20.0, 27.0, 32.0}) {
      const cv::Mat sigma(s < 10 ? 40 : 12, 120, CV_32F, cv::Scalar(s));
      EXPECT_LE(Rms(Fast(image, corner, sigma, ladder), Exact(image, corner, sigma)), 0.1)
          << file.path() << " sigma " << s;
    }
    // Ladders that end just there, whose last mixtures have nothing wider to lean on
    for (const auto& [most, short_ladder] : {std::pair(8.0, &to8), std::pair(3.0, &to3)}) {
      const cv::Mat sigma = Waves({150, 40}, most);
      EXPECT_LE(Rms(Fast(image, corner, sigma, *short_ladder), Exact(image, corner, sigma)), 0.1)
          << file.path() << " to " << most;
    }
  }
  EXPECT_GT(photographs, 0);
}

TEST(LadderBlur, IsWithinATenthOfALevelOnADrawnWall) {
  const cv::Mat image = DrawScene(DrawnScene::kBricks, {300, 200}, 0, 1, 0);
  for (double most : {0.7, 2.0, 6.0, 16.0}) {
    const cv::Mat sigma = Waves({120, 60}, most);
    EXPECT_LE(Rms(Fast(image, {90, 70}, sigma, LevelLadder::For(most)), Exact(image, {90, 70}, sigma)), 0.1)
        << most;
  }
}

// Encoded as sRGB after a blur in linear light, errors in the dark grow: 0.3/255 on photographs darkened to
// their square.
TEST(LadderBlur, IsWithinItsPromiseInLinearLight) {
  const std::filesystem::path file = SHIMMER_SHARED_DIR "/data/photos/kodak8/kodim08.png";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "data/photos/kodak8 is not beside this checkout";
  cv::Mat image;
  cv::imread(file).convertTo(image, CV_32FC3, 1 / 255.0);
  const cv::Mat light = DecodeSrgb(image.mul(image));
  for (double s : {0.6, 0.87, 1.2, 2.4, 6.9}) {
    const cv::Mat sigma(100, 160, CV_32F, cv::Scalar(s));
    const double rms = Rms(EncodeSrgb(Fast(light, {200, 150}, sigma, LevelLadder::For(8))),
                           EncodeSrgb(Exact(light, {200, 150}, sigma)));
    EXPECT_LE(rms, kLadderErrorLevelsEncoded) << s;
  }
}

TEST(LadderBlur, IsTheIdentityAtSigma0) {
  const cv::Mat image = SinesPicture({60, 40}, 0);
  const cv::Mat out = Fast(image, {10, 5}, cv::Mat::zeros(21, 37, CV_32F), LevelLadder::For(4));
  EXPECT_TRUE(SameBytes(out, image(cv::Rect(10, 5, 37, 21))));
}

// No step where one mixture ends and the next begins, at 0 or anywhere: two neighbouring floats give nearly
// the same.
TEST(LadderBlur, IsContinuousInSigma) {
  const cv::Mat image = DrawScene(DrawnScene::kChart, {200, 150}, 0, 1, 0);
  const LevelLadder& ladder = LevelLadder::For(32);
  for (double end = 0.0625; end <= 512; end *= 2) {
    const auto at = static_cast<float>(std::sqrt(end));
    const cv::Mat below(8, 60, CV_32F, cv::Scalar(std::nextafter(at, 0.0f) * (1 - 1e-6f))),
        above(8, 60, CV_32F, cv::Scalar(at * (1 + 1e-6f)));
    // weights change by about the 2e-6 between the sigmas, and are rounded to float
    EXPECT_LT(
        cv::norm(Fast(image, {50, 40}, below, ladder), Fast(image, {50, 40}, above, ladder), cv::NORM_INF),
        2e-5)
        << end;
  }
  const cv::Mat none = cv::Mat::zeros(8, 60, CV_32F), tiny(8, 60, CV_32F, cv::Scalar(1e-12)),
                small(8, 60, CV_32F, cv::Scalar(0.01));
  EXPECT_TRUE(SameBytes(Fast(image, {50, 40}, none, ladder), Fast(image, {50, 40}, tiny, ladder)));
  EXPECT_LT(cv::norm(Fast(image, {50, 40}, none, ladder), Fast(image, {50, 40}, small, ladder), cv::NORM_INF),
            1e-4);
}

TEST(LadderBlur, AConstantStaysConstant) {
  const cv::Mat image(90, 150, CV_32FC3, cv::Scalar(0.2, 0.7, 1.0));
  for (double most : {0.5, 3.0, 32.0}) {
    const cv::Mat out = Fast(image, {0, 0}, Waves({150, 30}, most), LevelLadder::For(most));
    EXPECT_LT(cv::norm(out, image(cv::Rect(0, 0, 150, 30)), cv::NORM_INF), 1e-6) << most;
  }
}

// An impulse keeps its energy at any constant sigma, wherever it lies on the coarse grids.
TEST(LadderBlur, KeepsEnergy) {
  for (double s : {0.3, 0.6, 1.3, 2.5, 3.7, 6.1})
    for (int phase = 0; phase < 8; phase += 3) {
      const int size = 16 * static_cast<int>(s + 2);
      cv::Mat image = cv::Mat::zeros(size, size, CV_32F);
      image.at<float>(size / 2 + phase, size / 2 - phase) = 1;
      const cv::Mat out =
          Fast(image, {0, 0}, cv::Mat(size, size, CV_32F, cv::Scalar(s)), LevelLadder::For(s));
      EXPECT_NEAR(cv::sum(out)[0], 1, 1e-4) << s << " " << phase;
    }
}

// Grids, stretches and vectors begin somewhere; a pixel must not know where.
TEST(LadderBlur, HasNoSeams) {
  const LevelLadder& ladder = LevelLadder::For(9);
  const int margin = ladder.margin_px();
  const LadderBlur blur(SinesPicture({700, 40}, margin), ladder);
  const cv::Mat sigma = Waves({700, 40}, 9);
  std::vector<float> whole(3 * 700), part(3 * 700);
  for (int y : {0, 17, 39}) {
    blur.Row({margin, y + margin}, RowOf(sigma, y), whole.data());
    for (const auto& [start, count] :
         {std::pair(0, 1), std::pair(1, 17), std::pair(255, 3), std::pair(333, 300), std::pair(699, 1)}) {
      blur.Row({margin + start, y + margin}, RowOf(sigma, y).subspan(start, count), part.data());
      for (int i = 0; i < 3 * count; ++i) EXPECT_EQ(part[i], whole[3 * start + i]) << start << " + " << i;
    }
  }
}

TEST(LadderBlur, WorksOnTheSmallestPicturesGreyOrColour) {
  for (cv::Size size : {cv::Size(1, 1), cv::Size(1, 17), cv::Size(17, 1)})
    for (int channels : {1, 3}) {
      const cv::Mat out =
          Fast(SinesPicture(size, 0, channels), {0, 0}, Waves(size, 32), LevelLadder::For(32));
      EXPECT_EQ(out.channels(), channels);
      EXPECT_TRUE(cv::checkRange(out, true, nullptr, -0.01, 1.01));
    }
}

TEST(LadderBlur, IsTheSameOnEveryTarget) {
  const cv::Mat image = SinesPicture({80, 30}, 0), sigma = Waves({61, 9}, 7);
  const LevelLadder& ladder = LevelLadder::For(7);
  cv::Mat first;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    const cv::Mat out = Fast(image, {5, 5}, sigma, ladder);
    if (first.empty()) first = out;
    EXPECT_TRUE(SameBytes(out, first)) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

// The cubics themselves: they sum to one everywhere, and hand over to each other without a step.
TEST(LevelLadder, MixturesSumToOneAndMeet) {
  for (double most : {0.1, 0.5, 3.0, 8.0, 32.0}) {
    const LevelLadder& ladder = LevelLadder::For(most);
    ASSERT_LE(ladder.mixtures().size(), 16u);
    std::vector<double> before(ladder.levels().size(), 0.0);
    before[0] = 1;
    for (const BlurMixture& mixture : ladder.mixtures()) {
      std::vector<double> first(before.size(), 0.0), last(before.size(), 0.0);
      for (double t : {0.0, 0.3, 1.0}) {
        double sum = 0;
        for (size_t r = 0; r < 4; ++r) {
          const auto& w = mixture.weight[r];
          const double value = w[0] + t * (w[1] + t * (w[2] + t * w[3]));
          sum += value;
          if (t == 0) first[mixture.level[r]] += value;
          if (t == 1) last[mixture.level[r]] += value;
        }
        EXPECT_NEAR(sum, 1, 1e-12);
      }
      for (size_t k = 0; k < before.size(); ++k)
        EXPECT_NEAR(first[k], before[k], 1e-9) << most << " level " << k;
      before = last;
    }
  }
}

}  // namespace
}  // namespace shimmer::sim
