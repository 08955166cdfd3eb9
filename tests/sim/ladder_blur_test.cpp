// The fast blur against the exact one.
#include "sim/ladder_blur.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "sim/colour.h"
#include "sim/crop.h"
#include "sim/drawn/drawn.h"
#include "sim/exact_blur.h"
#include "sim/gaussian.h"
#include "tests/sim/pictures.h"

namespace shimmer::sim {
namespace {

const std::filesystem::path kPhotographs = SHIMMER_SHARED_DIR "/data/photos/kodak8";

Planes PlanesOf(const cv::Mat& image) {
  Planes planes;
  cv::split(image, planes);
  return planes;
}

// The part of image at corner, of sigma's size, blurred by either way; what lies around it is the image's
// own, as far as each way asks for it.
cv::Mat Fast(const cv::Mat& image, cv::Point corner, const cv::Mat& sigma, const LevelLadder& ladder) {
  const int margin = ladder.margin_px();
  const LadderBlur blur(PlanesOf(CropWithHalo(image, {corner, sigma.size()}, margin)), ladder);
  Planes planes;
  for (int c = 0; c < image.channels(); ++c) planes.emplace_back(sigma.size(), CV_32F);
  blur.Band({margin, margin}, sigma, planes);
  cv::Mat out;
  cv::merge(planes, out);
  return out;
}

cv::Mat Exact(const cv::Mat& image, cv::Point corner, const cv::Mat& sigma) {
  double most;
  cv::minMaxLoc(sigma, nullptr, &most);
  const int margin = GaussianRadius(most);
  const cv::Mat frame = CropWithHalo(image, {corner, sigma.size()}, margin);
  cv::Mat out(sigma.size(), image.type());
  for (int y = 0; y < sigma.rows; ++y)
    ExactBlurRow(frame, {margin, y + margin}, {sigma.ptr<float>(y), static_cast<size_t>(sigma.cols)},
                 out.ptr<float>(y));
  return out;
}

// In 1/255 of the range.
double Rms(const cv::Mat& a, const cv::Mat& b) {
  return 255 * cv::norm(a, b, cv::NORM_L2) / std::sqrt(static_cast<double>(a.total() * a.channels()));
}

double LadderRms(const cv::Mat& image, cv::Point corner, const cv::Mat& sigma, const LevelLadder& ladder) {
  return Rms(Fast(image, corner, sigma, ladder), Exact(image, corner, sigma));
}

// A map with every sigma from 0 to most, in waves of a few tens of px.
cv::Mat Waves(cv::Size size, double most) {
  cv::Mat sigma(size, CV_32F);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      sigma.at<float>(y, x) = static_cast<float>(most * 0.5 * (1 - std::cos(0.11 * x + 0.07 * y)));
  return sigma;
}

class LadderBlurGrades : public testing::TestWithParam<LadderGrade> {
 protected:
  // Calls f(photograph) for each of them, CV_32FC3 in [0, 1].
  template <class F>
  static void ForEachPhotograph(const F& f) {
    if (!std::filesystem::exists(kPhotographs)) GTEST_SKIP() << "data/photos/kodak8 is not at hand";
    int photographs = 0;
    for (const auto& file : std::filesystem::directory_iterator(kPhotographs)) {
      if (file.path().extension() != ".png") continue;
      SCOPED_TRACE(file.path().filename());
      cv::Mat image;
      cv::imread(file.path()).convertTo(image, CV_32FC3, 1 / 255.0);
      ++photographs;
      f(image);
    }
    EXPECT_GT(photographs, 0);
  }
  static LevelLadder Ladder(double max_sigma_px) { return LevelLadder::For(max_sigma_px, GetParam()); }
  static LadderPromise Promise() { return PromiseOf(GetParam()); }
};

std::string NameOf(const testing::TestParamInfo<LadderGrade>& grade) {
  switch (grade.param) {
    case LadderGrade::kFine:
      return "Fine";
    case LadderGrade::kStandard:
      return "Standard";
    case LadderGrade::kCoarse:
      return "Coarse";
  }
  return {};
}
INSTANTIATE_TEST_SUITE_P(All, LadderBlurGrades, testing::ValuesIn(kLadderGrades), NameOf);

TEST_P(LadderBlurGrades, KeepItsPromiseOnPhotographsAtEverySigma) {
  ForEachPhotograph([](const cv::Mat& image) {
    const cv::Point corner(image.cols / 3, image.rows / 3);
    for (double s : {0.24, 0.42, 0.5, 0.7, 0.9, 1.2, 1.5, 2.0, 2.4, 3.0, 3.6, 4.3, 5.1, 7.0, 9.8, 14.0, 20.0,
                     27.0, 32.0}) {
      const cv::Mat sigma(s < 10 ? 40 : 12, 120, CV_32F, cv::Scalar(s));
      EXPECT_LE(LadderRms(image, corner, sigma, Ladder(32)), Promise().levels) << s;
      // A ladder that ends just there, whose last mixtures have the least to lean on
      EXPECT_LE(LadderRms(image, corner, sigma, Ladder(s)), Promise().levels) << s << ", short ladder";
    }
    for (double most : {3.0, 8.0})
      EXPECT_LE(LadderRms(image, corner, Waves({150, 40}, most), Ladder(most)), Promise().levels) << most;
  });
}

// The outermost pixels, for which the ladder's margin says what lies around: at the widest sigma.
TEST_P(LadderBlurGrades, KeepItsPromiseAtTheBorder) {
  for (double s : {0.5, 1.4, 3.0, 8.0, 20.0}) {
    double sum = 0;  // of squared errors
    int pixels = 0;
    ForEachPhotograph([&](const cv::Mat& image) {
      const cv::Rect area(image.cols / 3, image.rows / 3, 96, 64);
      const cv::Mat sigma(area.size(), CV_32F, cv::Scalar(s)),
          fast = Fast(image, area.tl(), sigma, Ladder(s));
      for (const cv::Rect& edge :
           {cv::Rect(0, 0, 96, 1), cv::Rect(0, 63, 96, 1), cv::Rect(0, 0, 1, 64), cv::Rect(95, 0, 1, 64)}) {
        const double rms = Rms(fast(edge), Exact(image, area.tl() + edge.tl(), sigma(edge)));
        sum += rms * rms * edge.area(), pixels += edge.area();
      }
    });
    if (pixels == 0) continue;
    EXPECT_LE(std::sqrt(sum / pixels), Promise().levels) << s;
  }
}

TEST_P(LadderBlurGrades, KeepItsPromiseOnADrawnWall) {
  const cv::Mat image = DrawScene(DrawnScene::kBricks, {300, 200}, 0, 1, 0);
  for (double most : {0.7, 2.0, 6.0, 16.0})
    EXPECT_LE(LadderRms(image, {90, 70}, Waves({120, 60}, most), Ladder(most)), Promise().levels) << most;
}

// Encoded as sRGB after a blur in linear light, errors in the dark grow; photographs darkened to their
// square.
TEST_P(LadderBlurGrades, KeepItsPromiseInLinearLight) {
  ForEachPhotograph([](const cv::Mat& image) {
    const cv::Mat light = DecodeSrgb(image.mul(image));
    for (double s : {0.5, 0.9, 1.2, 2.4, 6.9}) {
      const cv::Mat sigma(60, 120, CV_32F, cv::Scalar(s));
      const double rms = Rms(EncodeSrgb(Fast(light, {200, 150}, sigma, Ladder(8))),
                             EncodeSrgb(Exact(light, {200, 150}, sigma)));
      EXPECT_LE(rms, Promise().levels_encoded) << s;
    }
  });
}

TEST(LadderBlur, IsTheIdentityAtSigma0) {
  const cv::Mat image = SinesPicture({60, 40}, 0);
  for (LadderGrade grade : kLadderGrades) {
    const cv::Mat out = Fast(image, {10, 5}, cv::Mat::zeros(21, 37, CV_32F), LevelLadder::For(4, grade));
    EXPECT_TRUE(SameBytes(out, image(cv::Rect(10, 5, 37, 21))));
  }
}

// No step where one mixture ends and the next begins, at 0 or anywhere: two neighbouring floats give nearly
// the same.
TEST_P(LadderBlurGrades, AreContinuousInSigma) {
  const cv::Mat image = DrawScene(DrawnScene::kChart, {200, 150}, 0, 1, 0);
  const LevelLadder ladder = Ladder(32);
  const auto blurred = [&](double sigma_px) {
    return Fast(image, {50, 40}, cv::Mat(8, 60, CV_32F, cv::Scalar(sigma_px)), ladder);
  };
  for (double end = 0.0625; end <= 512; end *= 2) {
    const auto at = static_cast<float>(std::sqrt(end));
    // weights change by about the 2e-6 between the sigmas, and are rounded to float
    EXPECT_LT(cv::norm(blurred(at * (1 - 1e-6f)), blurred(at * (1 + 1e-6f)), cv::NORM_INF), 2e-5) << end;
  }
  EXPECT_TRUE(SameBytes(blurred(0), blurred(1e-12)));
  EXPECT_LT(cv::norm(blurred(0), blurred(0.01), cv::NORM_INF), 1e-4);
}

TEST_P(LadderBlurGrades, KeepConstantsConstant) {
  const cv::Mat image(90, 150, CV_32FC3, cv::Scalar(0.2, 0.7, 1.0));
  for (double most : {0.5, 3.0, 32.0}) {
    const cv::Mat out = Fast(image, {0, 0}, Waves({150, 30}, most), Ladder(most));
    EXPECT_LT(cv::norm(out, image(cv::Rect(0, 0, 150, 30)), cv::NORM_INF), 1e-6) << most;
  }
}

// An impulse keeps its energy at any constant sigma, wherever it lies on the coarse grids.
TEST_P(LadderBlurGrades, KeepEnergy) {
  for (double s : {0.3, 0.6, 1.3, 2.5, 3.7, 6.1})
    for (int phase = 0; phase < 8; phase += 3) {
      const int size = 16 * static_cast<int>(s + 2);
      cv::Mat image = cv::Mat::zeros(size, size, CV_32F);
      image.at<float>(size / 2 + phase, size / 2 - phase) = 1;
      const cv::Mat out = Fast(image, {0, 0}, cv::Mat(size, size, CV_32F, cv::Scalar(s)), Ladder(s));
      EXPECT_NEAR(cv::sum(out)[0], 1, 1e-4) << s << " " << phase;
    }
}

// Grids, stretches, bands and vectors begin somewhere; a pixel must not know where.
TEST_P(LadderBlurGrades, HaveNoSeams) {
  const LevelLadder ladder = Ladder(9);
  const int margin = ladder.margin_px();
  const cv::Size size(2100, 40);  // longer than what a band works on at a time
  const LadderBlur blur(PlanesOf(SinesPicture(size, margin)), ladder);
  const cv::Mat sigma = Waves(size, 9);
  const auto band = [&](cv::Rect area) {
    Planes out;
    for (int c = 0; c < 3; ++c) out.emplace_back(area.size(), CV_32F);
    blur.Band(cv::Point(margin, margin) + area.tl(), sigma(area), out);
    return out;
  };
  const Planes whole = band({{0, 0}, size});
  for (const cv::Rect& area :
       {cv::Rect(0, 0, 1, 1), cv::Rect(1, 17, 17, 1), cv::Rect(255, 3, 3, 30), cv::Rect(333, 39, 300, 1),
        cv::Rect(2040, 11, 60, 3), cv::Rect(2099, 0, 1, 40), cv::Rect(0, 5, 700, 7)}) {
    const Planes part = band(area);
    for (size_t c = 0; c < 3; ++c) EXPECT_TRUE(SameBytes(part[c], whole[c](area))) << area << c;
  }
}

TEST_P(LadderBlurGrades, WorkOnTheSmallestPicturesGreyOrColour) {
  for (cv::Size size : {cv::Size(1, 1), cv::Size(1, 17), cv::Size(17, 1)})
    for (int channels : {1, 3})
      for (double most : {0.3, 5.0, 32.0}) {
        const cv::Mat image = SinesPicture(size, 0, channels);
        const cv::Mat out = Fast(image, {0, 0}, Waves(size, most), Ladder(most));
        EXPECT_EQ(out.channels(), channels);
        EXPECT_TRUE(cv::checkRange(out, true, nullptr, -0.01, 1.01));
      }
}

TEST(LadderBlur, GivesAGreyFrameWhatItGivesEachOfThreeEqualPlanes) {
  const cv::Mat grey = SinesPicture({50, 20}, 0, 1), sigma = Waves({50, 20}, 6);
  cv::Mat colour;
  cv::merge(std::vector{grey, grey, grey}, colour);
  const LevelLadder ladder = LevelLadder::For(6, LadderGrade::kStandard);
  const cv::Mat one = Fast(grey, {0, 0}, sigma, ladder);
  for (const cv::Mat& plane : PlanesOf(Fast(colour, {0, 0}, sigma, ladder)))
    EXPECT_TRUE(SameBytes(plane, one));
}

TEST_P(LadderBlurGrades, AreTheSameOnEveryTarget) {
  const cv::Mat image = SinesPicture({80, 30}, 0), sigma = Waves({61, 9}, 20);
  cv::Mat first;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    const cv::Mat out = Fast(image, {5, 5}, sigma, Ladder(20));
    if (first.empty()) first = out;
    EXPECT_TRUE(SameBytes(out, first)) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

// The cubics themselves: they sum to one everywhere, and hand over to each other without a step.
TEST_P(LadderBlurGrades, MixturesSumToOneAndMeet) {
  for (double most : {0.1, 0.5, 3.0, 8.0, 32.0}) {
    const LevelLadder ladder = Ladder(most);
    std::vector<double> before(ladder.levels().size(), 0.0);
    before[0] = 1;
    for (const BlurMixture& mixture : ladder.mixtures()) {
      std::vector<double> first(before.size(), 0.0), last(before.size(), 0.0);
      for (double t : {0.0, 0.3, 1.0}) {
        double sum = 0;
        for (size_t r = 0; r < mixture.weight.size(); ++r) {
          const auto& w = mixture.weight[r];
          const double value = w[0] + t * (w[1] + t * (w[2] + t * w[3]));
          sum += value;
          if (t == 0) first[mixture.first_level + r] += value;
          if (t == 1) last[mixture.first_level + r] += value;
        }
        EXPECT_NEAR(sum, 1, 1e-12);
      }
      for (size_t k = 0; k < before.size(); ++k)
        EXPECT_NEAR(first[k], before[k], 1e-12) << most << " level " << k;
      before = last;
    }
  }
}

TEST(LevelLadder, RefusesSigmasOutOfItsRange) {
  for (double most : {0.0, -1.0, 33.0, std::nan("")})
    EXPECT_THROW(LevelLadder::For(most, LadderGrade::kStandard), std::invalid_argument) << most;
}

}  // namespace
}  // namespace shimmer::sim
