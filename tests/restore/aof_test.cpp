#include "restore/aof.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "tests/restore/frames.h"

namespace shimmer::restore {
namespace {

// Known flows, one after the other: the n-th call gives `flows[n]` everywhere, or the picture that is given.
class Known : public DenseFlow {
 public:
  explicit Known(std::vector<cv::Mat> flows) : flows_(std::move(flows)) {}
  size_t calls = 0;

 private:
  cv::Mat Compute(const cv::Mat&, const cv::Mat&) override { return flows_.at(calls++); }
  std::vector<cv::Mat> flows_;
};

SteadyFrame Seen(const cv::Mat& frame) { return {frame, cv::Mat(frame.size(), CV_8UC1, cv::Scalar(255))}; }

Place WithNeighbours(const cv::Mat& frame) {
  Place place{Seen(frame), {}};
  for (int n = 0; n < kMostNeighbours; ++n) place.neighbours.push_back(Seen(frame));
  return place;
}

std::vector<cv::Mat> RandomFlows(cv::Size size) {
  std::vector<cv::Mat> flows;
  cv::RNG random(3);
  for (int n = 0; n < kMostNeighbours; ++n)
    random.fill(flows.emplace_back(size, CV_32FC2), cv::RNG::NORMAL, 0, 5);
  return flows;
}

// The paper's mean, in double. Noise over the whole range weighs 1 - (1/255)^2 / variance: within 1e-3 of 1.
double MeanLength(const std::vector<cv::Mat>& flows, int first, int count, int y, int x) {
  double sum = 0;
  for (int n = first; n < count; ++n) {
    const auto& flow = flows[static_cast<size_t>(n)].at<cv::Vec2f>(y, x);
    sum += std::hypot(static_cast<double>(flow[0]), static_cast<double>(flow[1]));
  }
  return sum / (count - first);
}

TEST(Aof, NeighboursAreSpreadOverBothSides) {
  const int times[] = {-2, 2, -4, 4, -8, 8};
  for (int n = 0; n < kMostNeighbours; ++n) EXPECT_EQ(NeighbourAt(n), times[n]);
  EXPECT_EQ(MeanDistance(2), 2);
  EXPECT_EQ(MeanDistance(4), 3);
  EXPECT_DOUBLE_EQ(MeanDistance(6), 14.0 / 3);
}

TEST(Aof, IsTheMeanOfLengths) {
  const cv::Mat frame = Noise({31, 23}, CV_8UC3, 1);
  const std::vector<cv::Mat> flows = RandomFlows(frame.size());
  Known flow(flows);
  const std::vector<cv::Mat> aof = AofOf(flow, WithNeighbours(frame));
  ASSERT_EQ(aof.size(), 3u);
  EXPECT_EQ(flow.calls, 6u);  // each pair once
  for (size_t n = 0; n < 3; ++n)
    for (int y = 0; y < frame.rows; ++y)
      for (int x = 0; x < frame.cols; ++x) {
        const double truth = MeanLength(flows, 0, 2 * static_cast<int>(n) + 2, y, x);
        ASSERT_NEAR(aof[n].at<float>(y, x), truth, 2e-3 * truth + 1e-5);
      }
}

// The line that fits best in double: what moves on at a steady pace has that speed, and noise that is
// independent from frame to frame is left by 1 / sqrt(sum of squared times) of its deviation: 1/13.
TEST(Aof, SpeedIsThatOfTheLineThatFits) {
  const cv::Mat frame = Noise({31, 23}, CV_8UC3, 1);
  std::vector<cv::Mat> flows = RandomFlows(frame.size()), steady;
  for (int n = 0; n < kMostNeighbours; ++n)
    steady.push_back(cv::Mat(frame.size(), CV_32FC2, cv::Scalar(0.75, -1.0) * NeighbourAt(n)));
  Known flow(flows), on(steady);
  const cv::Mat speed = MotionOf(flow, WithNeighbours(frame)).speed;
  double squares = 0;
  for (int y = 0; y < frame.rows; ++y)
    for (int x = 0; x < frame.cols; ++x) {
      double slope[2] = {};
      for (int n = 0; n < kMostNeighbours; ++n)
        for (int axis = 0; axis < 2; ++axis)
          slope[axis] += NeighbourAt(n) *
                         static_cast<double>(flows[static_cast<size_t>(n)].at<cv::Vec2f>(y, x)[axis]) / 168;
      const double truth = std::hypot(slope[0], slope[1]);
      ASSERT_NEAR(speed.at<float>(y, x), truth, 2e-3 * truth + 1e-5);
      squares += truth * truth / 2;
    }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(speed.total())), 5 / std::sqrt(168.0), 0.02);
  EXPECT_NEAR(MotionOf(on, WithNeighbours(frame)).speed.at<float>(9, 9), 1.25, 3e-3);
}

// At the end of a video there are only earlier frames: what they have in common is the frame's own tilt.
TEST(Aof, SpeedForgetsTheFramesOwnTilt) {
  const cv::Mat frame = Noise({31, 23}, CV_8UC1, 1);
  std::vector<cv::Mat> flows;
  Place place = WithNeighbours(frame);
  for (int n = 0; n < kMostNeighbours; ++n)
    if (NeighbourAt(n) > 0)
      place.neighbours[static_cast<size_t>(n)] = {};
    else
      flows.push_back(cv::Mat(frame.size(), CV_32FC2, cv::Scalar(3, 0)));
  Known flow(flows);
  // 3 px aside of all three: of the line through (0, 0) and them the slope is 42 / 140 px a frame, not 3
  // / 4.67.
  EXPECT_NEAR(MotionOf(flow, place).speed.at<float>(9, 9), 42.0 / 140, 3e-3);
}

TEST(Aof, MissingAndFilledNeighboursAreLeftOut) {
  const cv::Mat frame = Noise({31, 23}, CV_8UC1, 1);
  const std::vector<cv::Mat> flows = RandomFlows(frame.size());
  Known flow({flows.begin() + 1, flows.end()});
  Place place = WithNeighbours(frame);
  place.neighbours[0] = {};
  place.neighbours[1].own.row(3).setTo(0);
  const cv::Mat aof = AofOf(flow, place, 4)[1];
  EXPECT_NEAR(aof.at<float>(5, 7), MeanLength(flows, 1, 4, 5, 7), 0.02);
  EXPECT_NEAR(aof.at<float>(3, 7), MeanLength(flows, 2, 4, 3, 7), 0.02);
}

TEST(Aof, NothingIsSeenWhereTheFrameIsFilledOrFlat) {
  cv::Mat frame = Noise({80, 40}, CV_16UC1, 1);
  frame.colRange(40, 80).setTo(30000);
  Known flow(RandomFlows(frame.size()));
  Place place = WithNeighbours(frame);
  place.current.own.row(0).setTo(0);
  const cv::Mat aof = AofOf(flow, place).back();
  EXPECT_EQ(cv::countNonZero(aof.row(0)), 0);
  EXPECT_LT(cv::norm(aof.colRange(50, 80), cv::NORM_INF), 0.01);  // further than the box from the texture
  EXPECT_GT(cv::mean(aof({0, 1, 30, 39}))[0], 1);
}

TEST(Aof, ClearnessAgainstItsEquation) {
  cv::Mat aof(13, 17, CV_32FC1), use(13, 17, CV_8UC1, cv::Scalar(255));
  cv::RNG(5).fill(aof, cv::RNG::UNIFORM, 0, 9);
  use.col(2).setTo(0);
  aof.col(2).setTo(100);
  double most = 0, sum = 0;
  int count = 0;
  for (int y = 0; y < aof.rows; ++y)
    for (int x = 0; x < aof.cols; ++x)
      if (x != 2) most = std::max(most, static_cast<double>(aof.at<float>(y, x)));
  for (int y = 0; y < aof.rows; ++y)
    for (int x = 0; x < aof.cols; ++x)
      if (x != 2) sum += std::abs(aof.at<float>(y, x) / most - 0.5), ++count;
  EXPECT_NEAR(Clearness(aof, use), sum / count, 1e-6);
  EXPECT_EQ(Clearness(cv::Mat::zeros(3, 3, CV_32FC1), cv::Mat(3, 3, CV_8UC1, cv::Scalar(255))), 0);
}

TEST(Aof, TheClearestNumberOfNeighboursAndOneThreshold) {
  // With N = 4 values are at the ends, with the others spread.
  cv::Mat spread(20, 20, CV_32FC1), clear = cv::Mat::zeros(20, 20, CV_32FC1);
  cv::RNG(5).fill(spread, cv::RNG::UNIFORM, 0, 6);
  clear(cv::Rect(4, 4, 5, 5)) = 6;
  AofChoice choice;
  EXPECT_EQ(choice.Settings().threshold_px, 0);
  for (int k = 0; k < 3; ++k) choice.Add({spread, clear, spread}, cv::Mat(20, 20, CV_8UC1, cv::Scalar(255)));
  EXPECT_EQ(choice.Settings().neighbours, 4);
  EXPECT_NEAR(choice.Settings().threshold_px, 3 / 1.5, 0.01);  // the middle between 0 and 6, a bin is 6/1024
}

}  // namespace
}  // namespace shimmer::restore
