#include "sim/layer.h"

#include <gtest/gtest.h>

namespace shimmer::sim {
namespace {

Layer Block(cv::Rect area, const cv::Vec4f& value) {
  return {area, cv::Mat(area.size(), CV_32FC4, cv::Scalar(value))};
}

float SampleOf(const cv::Mat& frame, int x, int y, int c) {
  const int i = x * frame.channels() + c;
  return frame.depth() == CV_8U    ? static_cast<float>(frame.ptr<uint8_t>(y)[i]) / 255
         : frame.depth() == CV_16U ? static_cast<float>(frame.ptr<uint16_t>(y)[i]) / 65535
                                   : frame.ptr<float>(y)[i];
}

// Half covered by red of 0.8: 0.4 + half of what was there; as far as it is seen. Rounded once.
TEST(Composite, LiesOverWhatWasThere) {
  for (const auto& [depth, top] :
       {std::pair(CV_8U, 255.0), std::pair(CV_16U, 65535.0), std::pair(CV_32F, 1.0)})
    for (const int channels : {3, 1}) {
      cv::Mat frame(6, 8, CV_MAKETYPE(depth, channels), cv::Scalar::all(0.6 * top));
      const cv::Mat before = frame.clone();
      Composite(Block({-1, 1, 4, 9}, {0.4f, 0, 0, 0.5f}), {-2, -1}, false,
                frame);  // pixel (0, 0) is (-2, -1)
      for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 8; ++x)
          for (int c = 0; c < channels; ++c) {
            const bool covered = x >= 1 && x < 5 && y >= 2;
            const float own = channels == 1 ? 0.4f / 3 : c == 0 ? 0.4f : 0, was = SampleOf(before, x, y, c);
            EXPECT_NEAR(SampleOf(frame, x, y, c), covered ? own + 0.5f * was : was,
                        covered ? (depth == CV_32F ? 1e-7 : 0.5001 / top) : 0)
                << x << " " << y << " " << c;
          }
    }
}

// Light adds up as light: half of white over black is 188 of 255, not 128.
TEST(Composite, InLinearLight) {
  cv::Mat frame = cv::Mat::zeros(1, 3, CV_8UC3);
  frame.at<cv::Vec3b>(2) = {7, 77, 177};
  Composite(Block({0, 0, 2, 1}, {0.5f, 0.5f, 0.5f, 0.5f}), {0, 0}, true, frame);
  EXPECT_EQ(frame.at<cv::Vec3b>(0), cv::Vec3b(188, 188, 188));
  EXPECT_EQ(frame.at<cv::Vec3b>(2), cv::Vec3b(7, 77, 177));
}

TEST(Composite, OutsideOfTheFrameAndUnderNoCoverageIsNothing) {
  cv::Mat frame(3, 3, CV_32FC3, cv::Scalar::all(0.25));
  const cv::Mat before = frame.clone();
  Composite(Block({3, 0, 5, 5}, {1, 1, 1, 1}), {0, 0}, false, frame);
  Composite(Block({0, 0, 3, 3}, {0, 0, 0, 0}), {0, 0}, true, frame);  // keeps its bits
  Composite({}, {0, 0}, false, frame);
  EXPECT_EQ(cv::norm(frame, before, cv::NORM_INF), 0);
  cv::Mat four(3, 3, CV_8UC4);
  EXPECT_THROW(Composite({}, {0, 0}, false, four), std::invalid_argument);
}

// Near over far, whatever else lies about: a chain of layers each of which meets the next becomes one.
TEST(Flattened, IsTheSameAsOneAfterTheOther) {
  const std::vector<Layer> layers = {Block({0, 0, 4, 4}, {0.5f, 0, 0, 0.5f}),
                                     Block({10, 0, 4, 4}, {0, 0.3f, 0, 0.6f}),
                                     Block({2, 2, 9, 2}, {0, 0, 0.2f, 0.4f}),
                                     Block({20, 5, 2, 2}, {1, 1, 1, 1}),
                                     {}};
  const std::vector<Layer> flat = Flattened(layers);
  ASSERT_EQ(flat.size(), 2u);
  cv::Mat one(9, 24, CV_32FC3, cv::Scalar::all(0.5)),
      other = one.clone(), mask = cv::Mat::zeros(9, 24, CV_32FC1), other_mask = mask.clone();
  for (const Layer& layer : layers) Composite(layer, {0, 0}, false, one), AddCoverage(layer, {0, 0}, mask);
  for (const Layer& layer : flat)
    Composite(layer, {0, 0}, false, other), AddCoverage(layer, {0, 0}, other_mask);
  EXPECT_LT(cv::norm(one, other, cv::NORM_INF), 1e-6);
  EXPECT_LT(cv::norm(mask, other_mask, cv::NORM_INF), 1e-6);
  EXPECT_FLOAT_EQ(mask.at<float>(2, 2), 0.7f);    // 0.4 + 0.6 * 0.5
  EXPECT_FLOAT_EQ(mask.at<float>(3, 10), 0.76f);  // 0.4 + 0.6 * 0.6
}

TEST(LayerMean, IsThatOverAllTimes) {
  LayerMean mean;
  mean.Add(Block({0, 0, 2, 1}, {1, 1, 1, 1}));
  mean.Add(Block({1, 0, 2, 1}, {1, 1, 1, 1}));
  mean.Add({});  // not there at the third
  const Layer layer = mean.Mean();
  EXPECT_EQ(layer.area, cv::Rect(0, 0, 3, 1));
  const float expected[] = {1 / 3.f, 2 / 3.f, 1 / 3.f};
  for (int x = 0; x < 3; ++x) EXPECT_FLOAT_EQ(layer.rgba.at<cv::Vec4f>(0, x)[3], expected[x]);
  LayerMean none;
  none.Add({});
  EXPECT_TRUE(none.Mean().area.empty());
}

}  // namespace
}  // namespace shimmer::sim
