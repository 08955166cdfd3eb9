#include "restore/scene_growth.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

namespace shimmer::restore {
namespace {

constexpr double kTolerance = 3, kNoise = 1;  // levels

// A wall with an edge at x = 40, and noise: 8 samples of 65x33 px, in which nothing moves yet.
std::vector<SceneSample> Wall(int channels = 1) {
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, kNoise);
  std::vector<SceneSample> samples;
  for (int k = 0; k < 8; ++k) {
    cv::Mat frame(33, 65, CV_32FC(channels));
    for (int y = 0; y < frame.rows; ++y)
      for (int i = 0; i < frame.cols * channels; ++i)
        frame.ptr<float>(y)[i] = (i / channels < 40 ? 100 : 180) + noise(random);
    samples.push_back({frame, cv::Mat(frame.size(), CV_8UC1, cv::Scalar(255)), {}, {}});
  }
  return samples;
}

struct Scene {
  cv::Mat picture, known;
};

// The first sample is known but for the rectangle, where the picture is 0.
Scene KnownAround(const std::vector<SceneSample>& samples, cv::Rect unknown) {
  Scene scene{samples[0].frame.clone(), samples[0].own.clone()};
  scene.picture(unknown).setTo(0), scene.known(unknown).setTo(0);
  return scene;
}

TEST(SceneGrowth, ReachesAcrossWhatLooksAlike) {
  for (const int channels : {1, 3}) {
    const auto samples = Wall(channels);
    Scene scene = KnownAround(samples, {10, 8, 45, 17});  // with the edge in it
    GrowScene(scene.picture, scene.known, samples, kTolerance);
    // The edge's two sides are each continued from their own.
    EXPECT_EQ(cv::countNonZero(scene.known), 33 * 65);
    for (const cv::Rect side : {cv::Rect(10, 8, 30, 17), cv::Rect(40, 8, 15, 17)}) {
      const double level = side.x < 40 ? 100 : 180;
      // A median of 8 has a deviation of 0.45 of the noise's; 5 of that.
      EXPECT_LT(cv::norm(scene.picture(side),
                         cv::Mat(side.size(), scene.picture.type(), cv::Scalar::all(level)), cv::NORM_INF),
                2.3 * kNoise);
    }
  }
}

TEST(SceneGrowth, StopsAtAThingThatIsAlwaysThere) {
  auto samples = Wall();
  const cv::Rect thing(20, 12, 9, 9);
  for (auto& sample : samples) sample.frame(thing).setTo(130);
  Scene scene = KnownAround(samples, {12, 5, 24, 23});
  GrowScene(scene.picture, scene.known, samples, kTolerance);
  cv::Mat unknown = scene.known == 0, expected = cv::Mat::zeros(unknown.size(), CV_8UC1);
  expected(thing).setTo(255);
  EXPECT_EQ(cv::norm(unknown, expected, cv::NORM_INF), 0);
  EXPECT_EQ(cv::countNonZero(scene.picture(thing)), 0);  // untouched
}

TEST(SceneGrowth, LeavesWhatAThingPassesOverForMoreThanAFifth) {
  auto samples = Wall();
  const cv::Rect often(14, 10, 5, 9), seldom(28, 10, 5, 9);
  for (const size_t k : {0, 1}) samples[k].frame(often).setTo(30);
  samples[5].frame(seldom).setTo(30);
  Scene scene = KnownAround(samples, {10, 6, 26, 17});
  GrowScene(scene.picture, scene.known, samples, kTolerance);
  EXPECT_EQ(cv::countNonZero(scene.known(often)), 0);
  EXPECT_EQ(cv::countNonZero(scene.known(seldom)), seldom.area());
  EXPECT_GT(scene.picture.at<float>(14, 30), 95);  // of the samples without it
}

TEST(SceneGrowth, FilledPxAreNoSamples) {
  auto samples = Wall();
  const cv::Rect part(14, 10, 5, 9), lonely(28, 10, 5, 9);
  for (size_t k = 0; k < samples.size(); ++k) {
    if (k < 6) samples[k].own(part).setTo(0), samples[k].frame(part).setTo(0);
    if (k < 7) samples[k].own(lonely).setTo(0), samples[k].frame(lonely).setTo(0);
  }
  Scene scene = KnownAround(samples, {10, 6, 26, 17});
  GrowScene(scene.picture, scene.known, samples, kTolerance);
  EXPECT_EQ(cv::countNonZero(scene.known(part)), part.area());
  EXPECT_EQ(cv::countNonZero(scene.known(lonely)), 0);  // seen once: no proof
}

TEST(SceneGrowth, OfNothingIsNothing) {
  const auto samples = Wall();
  Scene scene = KnownAround(samples, {0, 0, 65, 33});
  GrowScene(scene.picture, scene.known, samples, kTolerance);
  EXPECT_EQ(cv::countNonZero(scene.known), 0);
}

}  // namespace
}  // namespace shimmer::restore
