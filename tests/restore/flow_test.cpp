#include "restore/flow.h"

#include <gtest/gtest.h>

#include "tests/restore/frames.h"

namespace shimmer::restore {
namespace {

TEST(Flow, OfAMovedFrameIsItsShift) {
  struct Case {
    FlowMaker maker;
    double error_px;
  };
  for (const auto& [maker, error_px] : {Case{DisFlows(), 0.1}, Case{FarnebackFlows(), 0.15}})
    for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC1})
      for (const cv::Size size : {cv::Size(160, 120), cv::Size(1201, 203)}) {
        cv::Mat scene = Noise(size + cv::Size(8, 8), type, 4);
        for (int i = 0; i < 4; ++i) cv::blur(scene, scene, {7, 7});
        cv::normalize(scene.clone(), scene, 0, WhiteOf(scene.depth()), cv::NORM_MINMAX);
        const cv::Mat flow = maker()->Flow(scene({{4, 4}, size}).clone(), scene({{1, 2}, size}).clone());
        ASSERT_EQ(flow.size(), size);
        // What is at p of the first is at p + (3, 2) of the second. Means over the inside, where nothing
        // leaves. Patches are compared to a tenth of a px, windows of 15 px (Farneback's) less well: of two
        // px at half size, where patches are cut by more edges.
        const double tolerance = size.width > 1000 ? 0.3 : error_px;
        const cv::Scalar mean = cv::mean(flow(cv::Rect(20, 20, size.width - 40, size.height - 40)));
        EXPECT_NEAR(mean[0], 3, tolerance) << type << size;
        EXPECT_NEAR(mean[1], 2, tolerance) << type << size;
      }
}

TEST(Flow, TinyFramesAndBadOnes) {
  const cv::Mat tiny = Noise({5, 3}, CV_8UC3, 1);
  for (const FlowMaker& maker : {DisFlows(), FarnebackFlows()}) {
    EXPECT_EQ(maker()->Flow(tiny, tiny).size(), tiny.size());
    EXPECT_THROW(maker()->Flow(tiny, cv::Mat()), std::invalid_argument);
    EXPECT_THROW(maker()->Flow(tiny, Noise({5, 4}, CV_8UC3, 1)), std::invalid_argument);
    EXPECT_THROW(maker()->Flow(tiny, Noise({5, 3}, CV_8UC1, 1)), std::invalid_argument);
  }
}

}  // namespace
}  // namespace shimmer::restore
