#include "restore/shift_search.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shimmer::restore {
namespace {

cv::Mat Noise(cv::Size size, uint64_t seed) {
  cv::Mat noise(size, CV_32FC1);
  cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0, 1);
  return noise;
}

// The normalised correlation over the overlap, from its definition and in double.
double CorrelationAt(const cv::Mat& detail, const Mosaic& mosaic, cv::Point shift) {
  double product = 0, a = 0, b = 0;
  for (int y = 0; y < detail.rows; ++y)
    for (int x = 0; x < detail.cols; ++x) {
      const cv::Point at(x + mosaic.margin_px() - shift.x, y + mosaic.margin_px() - shift.y);
      if (mosaic.whole().frames.at<float>(at) == 0) continue;
      const double f = detail.at<float>(y, x), m = mosaic.whole().mean.at<float>(at);
      product += f * m, a += f * f, b += m * m;
    }
  return product / std::sqrt(a * b);
}

// Two crops of one picture of noise, whatever overlap they have; no other shift comes near.
TEST(BestShifts, FindsWhereACropLies) {
  const cv::Size size(61, 48);
  const int margin = 25;
  const cv::Mat picture = Noise({size.width + 2 * margin, size.height + 2 * margin}, 1);
  Mosaic mosaic(size, margin);
  mosaic.Add(picture({{margin, margin}, size}), {margin, margin});
  for (const cv::Point shift : {cv::Point(0, 0), cv::Point(-7, 11), cv::Point(24, 3), cv::Point(-25, -20)}) {
    // s: the frame's p + s shows what lies at p.
    const cv::Mat frame = picture({cv::Point(margin, margin) - shift, size});
    const auto peaks = BestShifts(frame, mosaic, 3);
    ASSERT_EQ(peaks.size(), 3u);
    EXPECT_LT(cv::norm(peaks[0].shift_px - cv::Point2d(shift)), 0.1) << shift;
    EXPECT_NEAR(peaks[0].correlation, 1, 1e-4);
    EXPECT_GT(peaks[0].clearness, 2 * peaks[1].clearness);
    for (const ShiftPeak& peak : peaks)  // the twin, at the px of the peak
      EXPECT_NEAR(peak.correlation,
                  CorrelationAt(frame, mosaic, {cvRound(peak.shift_px.x), cvRound(peak.shift_px.y)}), 1e-3);
  }
}

TEST(BestShifts, FlatFramesHaveNone) {
  Mosaic mosaic({40, 30}, 6);
  EXPECT_TRUE(BestShifts(Noise({40, 30}, 1), mosaic, 3).empty());  // nothing was seen yet
  mosaic.Add(Noise({40, 30}, 1), {6, 6});
  EXPECT_TRUE(BestShifts(cv::Mat::zeros(30, 40, CV_32FC1), mosaic, 3).empty());
}

// Without a frame the mosaic is what it was before that came.
TEST(Mosaic, WithoutAFrame) {
  const cv::Size size(30, 20);
  const cv::Mat first = Noise(size, 1), second = Noise(size, 2);
  Mosaic one(size, 5), both(size, 5);
  one.Add(first, {5, 5});
  both.Add(first, {5, 5});
  both.Add(second, {2, 9});
  const cv::Rect area(1, 3, 36, 22);
  const MosaicPart expected = one.Part(area), without = both.PartWithout(area, second, {2, 9});
  EXPECT_EQ(cv::norm(expected.frames, without.frames, cv::NORM_INF), 0);
  EXPECT_LT(cv::norm(expected.mean, without.mean, cv::NORM_INF), 1e-5);
  EXPECT_GT(cv::norm(both.Part(area).mean, expected.mean, cv::NORM_INF), 0.5);
}

}  // namespace
}  // namespace shimmer::restore
