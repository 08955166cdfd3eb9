#include "restore/scene_reference.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <stdexcept>

#include "restore/psnr.h"
#include "tests/restore/frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

cv::Mat NoFlow(const cv::Mat& from, const cv::Mat&) { return cv::Mat::zeros(from.size(), CV_32FC2); }

// Of values in [0, 1], as PSNR takes them.
cv::Mat Part(const SceneReference& reference) { return reference.grey / 255; }

// Frames of one level each, of which the left half hides some. Where nothing moves, the mean of the rest,
// trusted by its share: 2 of 12 frames are 4 * 2 / 12 of what is enough.
TEST(SceneReferenceMean, LeavesOutWhatIsHidden) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC1}) {
    const cv::Size size(120, 40);
    SceneReferenceMean mean(NoFlow);
    for (int k = 0; k < 12; ++k) {
      cv::Mat weight(size, CV_8UC1, cv::Scalar(255));
      if (k >= 2) weight.colRange(0, 60) = 0;
      mean.Add({Flat(size, type, 40 + 10 * k), weight});
    }
    const SceneReference reference = mean.Result();
    ASSERT_EQ(reference.grey.size(), size);
    // What hides the scene weighs 1/100 of it: 10 frames of level 105 on average beside 2 of 45.
    const double hidden = (2 * 45 + 10 * 0.01 * 105) / (2 + 10 * 0.01);
    EXPECT_NEAR(static_cast<double>(reference.grey.at<float>(20, 20)), hidden, 0.01) << type;
    EXPECT_NEAR(static_cast<double>(reference.grey.at<float>(20, 100)), 95, 0.01) << type;
    // (15 px from the edge between the halves, which is blurred by 4 px)
    EXPECT_NEAR(static_cast<double>(reference.trust.at<float>(20, 20)), 4.0 * 2 / 12, 1e-3) << type;
    EXPECT_NEAR(static_cast<double>(reference.trust.at<float>(20, 100)), 1, 1e-3) << type;
    for (int x = 1; x < size.width; ++x)
      EXPECT_GE(reference.trust.at<float>(20, x), reference.trust.at<float>(20, x - 1) - 1e-6f) << x;
  }
}

// Something crosses a scene seen through air that moves. The reference is nearer to the scene than the plain
// mean of the frames without it, which the tilt blurs, and is where that is.
TEST(SceneReferenceMean, IsSharperThanTheMean) {
  const cv::Size size(170, 131);
  SceneReferenceMean mean, plain(NoFlow);
  for (uint32_t k = 0; k < 16; ++k) {
    const cv::Rect box(10 * static_cast<int>(k), 50, 30, 30), whole({}, size);
    cv::Mat weight(size, CV_8UC1, cv::Scalar(255));
    weight(box & whole) = 0;
    const cv::Mat frame = SeenFrame({.size = size, .tilt_rms_px = 1.5, .frame = k, .box = box});
    mean.Add({frame, weight});
    plain.Add({frame, weight});
  }
  const cv::Mat scene = SeenFrame({.size = size});
  const SceneReference found = mean.Result();
  // Blur by 1.5 px takes some 2 dB more from the mean than its tilts' own mean, 1.5 / sqrt(16) px, does.
  EXPECT_GT(Psnr(Part(found), scene), Psnr(Part(plain.Result()), scene) + 1);
  const cv::Rect path(30, 55, 100, 20);
  EXPECT_GT(Psnr(Part(found)(path), scene(path)), Psnr(Part(plain.Result())(path), scene(path)));
}

TEST(SceneReferenceMean, IsHalfOfLargeFrames) {
  SceneReferenceMean mean;
  for (uint32_t k = 0; k < 3; ++k) mean.Add({Noise({1203, 41}, CV_8UC3, k), Noise({1203, 41}, CV_8UC1, k)});
  EXPECT_EQ(mean.Result().grey.size(), cv::Size(601, 20));
  EXPECT_EQ(mean.Result().trust.size(), cv::Size(601, 20));
}

TEST(SceneReferenceMean, IsTheSameOnAnyNumberOfThreads) {
  SceneReferenceMean mean;
  for (uint32_t k = 0; k < 6; ++k)
    mean.Add({SeenFrame({.size = {120, 90}, .tilt_rms_px = 1, .frame = k}), Noise({120, 90}, CV_8UC1, k)});
  const SceneReference many = mean.Result();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const SceneReference alone = mean.Result();
  EXPECT_EQ(cv::norm(many.grey, alone.grey, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(many.trust, alone.trust, cv::NORM_INF), 0);
}

TEST(SceneReferenceMean, RefusesBadInput) {
  SceneReferenceMean mean;
  EXPECT_TRUE(mean.Result().grey.empty());
  EXPECT_THROW(mean.Add({}), std::invalid_argument);
  EXPECT_THROW(SceneReferenceMean().Add({cv::Mat::zeros(15, 40, CV_8UC1), {}}), std::invalid_argument);
  SceneReferenceMean other;
  other.Add({cv::Mat::zeros(40, 40, CV_8UC1), {}});
  EXPECT_THROW(other.Add({cv::Mat::zeros(40, 41, CV_8UC1), {}}), std::invalid_argument);
  EXPECT_THROW(other.Add({cv::Mat::zeros(40, 40, CV_8UC1), cv::Mat::zeros(40, 40, CV_8UC3)}),
               std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
