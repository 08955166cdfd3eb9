#include "sim/drawn/drawn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace shimmer::sim {
namespace {

constexpr DrawnScene kScenes[] = {DrawnScene::kChart, DrawnScene::kBricks, DrawnScene::kText,
                                  DrawnScene::kStar, DrawnScene::kStripes};

bool SameBits(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size() || a.type() != b.type()) return false;
  for (int y = 0; y < a.rows; ++y)
    if (std::memcmp(a.ptr(y), b.ptr(y), a.cols * a.elemSize()) != 0) return false;
  return true;
}

cv::Mat_<float> GreyOf(const cv::Mat& rgb) {
  cv::Mat grey;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

class EveryScene : public testing::TestWithParam<DrawnScene> {};
INSTANTIATE_TEST_SUITE_P(Drawn, EveryScene, testing::ValuesIn(kScenes),
                         [](const auto& info) { return kDrawnSceneNames[size_t(info.param)]; });

TEST_P(EveryScene, HasTheSameCropWhateverTheHalo) {
  for (const cv::Size size : {cv::Size(64, 64), cv::Size(333, 127), cv::Size(1, 17)}) {
    for (const double scale : {0.7, 2.0}) {
      const cv::Mat crop = DrawScene(GetParam(), size, 0, scale, 3);
      for (const int halo : {1, 7, 200}) {
        const cv::Mat wide = DrawScene(GetParam(), size, halo, scale, 3);
        ASSERT_EQ(wide.size(), size + cv::Size(2 * halo, 2 * halo));
        EXPECT_TRUE(SameBits(crop, wide(cv::Rect({halo, halo}, size)))) << size << " halo " << halo;
      }
    }
  }
}

TEST_P(EveryScene, GoesOnInTheHalo) {
  // A halo that were blank would be black; what is drawn never is, nowhere near as dark on average as 0.05.
  const cv::Mat wide = DrawScene(GetParam(), {64, 64}, 40, 1, 0);
  for (const cv::Rect side : {cv::Rect(0, 0, 144, 40), cv::Rect(0, 104, 144, 40), cv::Rect(0, 0, 40, 144),
                              cv::Rect(104, 0, 40, 144)})
    EXPECT_GT(cv::mean(GreyOf(wide(side)))[0], 0.05);
}

TEST_P(EveryScene, IsFiniteAndInRangeAtAnySizeAndScale) {
  for (const cv::Size size :
       {cv::Size(1, 1), cv::Size(1, 17), cv::Size(17, 1), cv::Size(333, 127), cv::Size(900, 3)}) {
    for (const double scale : {0.001, 0.01, 0.3, 1.0, 16.0, 1000.0}) {
      const cv::Mat image = DrawScene(GetParam(), size, 5, scale, std::numeric_limits<uint64_t>::max());
      ASSERT_EQ(image.type(), CV_32FC3);
      EXPECT_TRUE(cv::checkRange(image.reshape(1), true, nullptr, 0.0, std::nextafter(1.0, 2.0)))
          << size << " scale " << scale;
    }
  }
}

TEST_P(EveryScene, HasMiddlingLightAndGoodContrast) {
  for (const cv::Size size : {cv::Size(64, 64), cv::Size(256, 256), cv::Size(333, 127), cv::Size(640, 360)}) {
    for (const uint64_t variation : {uint64_t{0}, uint64_t{1}, uint64_t{2}, uint64_t{1} << 63}) {
      cv::Scalar mean, deviation;
      cv::meanStdDev(GreyOf(DrawScene(GetParam(), size, 0, 1, variation)), mean, deviation);
      EXPECT_GT(mean[0], 0.2) << size << " variation " << variation;
      EXPECT_LT(mean[0], 0.8) << size << " variation " << variation;
      EXPECT_GT(deviation[0], 0.1) << size << " variation " << variation;
    }
  }
}

TEST_P(EveryScene, DependsOnItsArgumentsAlone) {
  const cv::Mat first = DrawScene(GetParam(), {90, 70}, 3, 1, 0);
  const cv::Mat other = DrawScene(GetParam(), {90, 70}, 3, 1, 1);
  EXPECT_TRUE(SameBits(first, DrawScene(GetParam(), {90, 70}, 3, 1, 0)));
  EXPECT_FALSE(SameBits(first, other));
  EXPECT_FALSE(SameBits(other, DrawScene(GetParam(), {90, 70}, 3, 1, uint64_t{1} << 32)));
}

TEST_P(EveryScene, RefusesWhatCannotBeDrawn) {
  EXPECT_THROW(DrawScene(GetParam(), {0, 5}, 0, 1, 0), std::invalid_argument);
  EXPECT_THROW(DrawScene(GetParam(), {5, -1}, 0, 1, 0), std::invalid_argument);
  EXPECT_THROW(DrawScene(GetParam(), {5, 5}, -1, 1, 0), std::invalid_argument);
  EXPECT_THROW(DrawScene(GetParam(), {5, 5}, 0, 0, 0), std::invalid_argument);
  EXPECT_THROW(DrawScene(GetParam(), {5, 5}, 0, std::nan(""), 0), std::invalid_argument);
  EXPECT_THROW(DrawScene(GetParam(), {5, 5}, 0, std::numeric_limits<double>::infinity(), 0),
               std::invalid_argument);
}

TEST(DrawnSceneNames, LeadToTheirScenes) {
  for (const DrawnScene scene : kScenes) EXPECT_EQ(DrawnSceneNamed(kDrawnSceneNames[size_t(scene)]), scene);
  EXPECT_THROW(DrawnSceneNamed("Chart"), std::invalid_argument);
  EXPECT_THROW(DrawnSceneNamed(""), std::invalid_argument);
}

TEST(Chart, ReachesBarsOfOnePixel) {
  // Somewhere, five pixels in a row alternate at 90 % of the image's contrast; so do five in a column.
  const cv::Mat_<float> upright = GreyOf(DrawScene(DrawnScene::kChart, {256, 256}, 0, 1, 0));
  const cv::Mat_<float> level = upright.t();
  double low, high;
  cv::minMaxLoc(upright, &low, &high);
  for (const cv::Mat_<float>& image : {upright, level}) {
    bool found = false;
    for (int y = 0; y < image.rows && !found; ++y) {
      for (int x = 0; x + 5 <= image.cols && !found; ++x) {
        found = true;
        for (int i = 0; i < 4; ++i)
          found = found && (i % 2 ? 1 : -1) * (image(y, x + i + 1) - image(y, x + i)) > 0.9 * (high - low);
      }
    }
    EXPECT_TRUE(found);
  }
}

}  // namespace
}  // namespace shimmer::sim
