#include "restore/segment.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "restore/mask_scores.h"
#include "tests/restore/frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

struct Video {
  std::vector<SteadyFrame> frames;
  std::vector<cv::Mat> truth;  // CV_8UC1, 255 moving
};

// A textured scene whose pixels are moved by tilt_px RMS, smoothly (waves of 30 to 90 px), each frame anew,
// and before it a textured box of a fifth of both sides that crosses it.
Video Road(cv::Size size, int type, int count, bool box, double tilt_px = 0.7) {
  const Waves scene(1, 40, 6, 40, 30), on_box(2, 20, 4, 12, 15);
  Video video;
  for (int k = 0; k < count; ++k) {
    const auto seed = static_cast<uint32_t>(100 + 2 * k);
    const Waves tilt_x(seed, 10, 30, 90, tilt_px), tilt_y(seed + 1, 10, 30, 90, tilt_px);
    const cv::Rect where(size.width * k / count, size.height * 2 / 5, size.width / 5, size.height / 5);
    cv::Mat frame(size, CV_MAKETYPE(CV_64F, CV_MAT_CN(type))), moving = cv::Mat::zeros(size, CV_8UC1);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const bool in = box && where.contains({x, y});
        const double level =
            in ? 200 + on_box.At(x - where.x, y) : 90 + scene.At(x + tilt_x.At(x, y), y + tilt_y.At(x, y));
        for (int c = 0; c < frame.channels(); ++c)
          frame.ptr<double>(y)[x * frame.channels() + c] =
              std::clamp(level - 10 * c, 0.0, 255.0) / 255 * WhiteOf(CV_MAT_DEPTH(type));
        moving.at<uint8_t>(y, x) = in ? 255 : 0;
      }
    frame.convertTo(frame, CV_MAT_DEPTH(type));
    video.frames.push_back({frame, cv::Mat(size, CV_8UC1, cv::Scalar(255))});
    video.truth.push_back(moving);
  }
  return video;
}

std::vector<cv::Mat> Masks(const std::vector<SteadyFrame>& frames, SegmentMethod method) {
  const int count = static_cast<int>(frames.size());
  SegmentSurvey survey(method);
  for (const int k : SurveyPlaces(count)) survey.Add(PlaceAt(k, frames), k);
  Segmenter segmenter(survey.Settings());
  std::vector<cv::Mat> masks;
  for (const SteadyFrame& frame : frames)
    if (const auto mask = segmenter.Next(frame)) masks.push_back(*mask);
  while (const auto mask = segmenter.Rest()) masks.push_back(*mask);
  return masks;
}

double Iou(const std::vector<cv::Mat>& masks, const std::vector<cv::Mat>& truth) {
  MaskCounts counts;
  for (size_t k = 0; k < truth.size(); ++k) counts += CompareMasks(masks.at(k), truth[k]);
  return counts.Iou();
}

constexpr SegmentMethod kBoth[] = {SegmentMethod::kAof, SegmentMethod::kFused};

TEST(Segment, FindsABoxThatMoves) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC1}) {
    const Video video = Road({161, 119}, type, 20, true);
    const std::vector<cv::Mat> fused = Masks(video.frames, SegmentMethod::kFused);
    ASSERT_EQ(fused.size(), video.frames.size());
    // The box is 32x23 px; smoothing by 1.5 px may move its rim by two: 736 of 36 * 27 px.
    EXPECT_GT(Iou(fused, video.truth), 0.75) << type;
    // The flow smears it over its way: it need only find it, and be worse.
    const double aof = Iou(Masks(video.frames, SegmentMethod::kAof), video.truth);
    EXPECT_GT(aof, 0.1) << type;
    EXPECT_LT(aof, Iou(fused, video.truth)) << type;
  }
}

TEST(Segment, MasksAreSoftAtTheRimAlone) {
  const Video video = Road({161, 119}, CV_8UC3, 20, true);
  const std::vector<cv::Mat> masks = Masks(video.frames, SegmentMethod::kFused);
  int between = 0;
  for (size_t k = 0; k < masks.size(); ++k) {
    cv::Mat inside;
    cv::erode(video.truth[k], inside, cv::Mat::ones(9, 9, CV_8UC1));
    between += cv::countNonZero((masks[k] > 0) & (masks[k] < 255));
    EXPECT_EQ(cv::countNonZero(inside & (masks[k] < 128)), 0) << k;
  }
  EXPECT_GT(between, 0);
}

int MovingPx(double tilt_px) {
  int moving = 0;
  for (const cv::Mat& mask :
       Masks(Road({161, 119}, CV_8UC3, 20, false, tilt_px).frames, SegmentMethod::kFused))
    moving += cv::countNonZero(mask);
  return moving;
}

TEST(Segment, TurbulenceAloneMovesNothing) {
  for (const double tilt_px : {0.2, 0.7}) EXPECT_EQ(MovingPx(tilt_px), 0) << tilt_px;
}

TEST(Segment, FramesAllAlikeMoveNothing) {
  for (const SegmentMethod method : kBoth)
    for (const cv::Mat& frame : {Noise({64, 64}, CV_8UC3, 1), Flat({64, 64}, CV_8UC1, 0)}) {
      const SteadyFrame steady{frame, cv::Mat(frame.size(), CV_8UC1, cv::Scalar(255))};
      for (const cv::Mat& mask : Masks(std::vector<SteadyFrame>(9, steady), method))
        EXPECT_EQ(cv::countNonZero(mask), 0);
    }
}

TEST(Segment, OneFrameAndTinyFrames) {
  for (const SegmentMethod method : kBoth)
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(7, 3), cv::Size(1003, 2), cv::Size(33, 17)})
      for (const int count : {1, 2, 5}) {
        const std::vector<SteadyFrame> frames = Road(size, CV_8UC3, count, false).frames;
        const std::vector<cv::Mat> masks = Masks(frames, method);
        ASSERT_EQ(masks.size(), frames.size()) << size;
        for (const cv::Mat& mask : masks) {
          EXPECT_EQ(mask.size(), size);
          if (count == 1) {
            EXPECT_EQ(cv::countNonZero(mask), 0);  // nothing to compare it with
          }
        }
      }
}

// Where all of it moves in all frames, what is there most is taken for the scene: masks are there, and none
// of the numbers in them is out of order.
TEST(Segment, MotionEverywhereIsStated) {
  std::vector<SteadyFrame> frames;
  for (uint32_t k = 0; k < 9; ++k)
    frames.push_back({Noise({64, 48}, CV_8UC1, k), cv::Mat(48, 64, CV_8UC1, cv::Scalar(255))});
  for (const SegmentMethod method : kBoth) EXPECT_EQ(Masks(frames, method).size(), frames.size());
}

TEST(Segment, FilledBordersNeverMove) {
  Video video = Road({161, 119}, CV_8UC3, 12, true);
  for (size_t k = 0; k < video.frames.size(); ++k) {
    const cv::Rect border(0, 0, 161, 10 + static_cast<int>(k));
    video.frames[k].frame(border).setTo(cv::Scalar::all(k % 2 == 0 ? 255 : 0));
    video.frames[k].own(border).setTo(0);
  }
  for (const SegmentMethod method : kBoth) {
    const std::vector<cv::Mat> masks = Masks(video.frames, method);
    for (size_t k = 0; k < masks.size(); ++k)
      EXPECT_EQ(cv::countNonZero(masks[k] & (video.frames[k].own == 0)), 0) << k;
  }
}

TEST(Segment, TheSameOnAnyNumberOfThreads) {
  const Video video = Road({161, 119}, CV_8UC3, 12, true);
  for (const SegmentMethod method : kBoth) {
    std::vector<cv::Mat> masks[2];
    for (const size_t threads : {1u, 4u}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      masks[threads == 4] = Masks(video.frames, method);
    }
    for (size_t k = 0; k < masks[0].size(); ++k)
      EXPECT_EQ(cv::norm(masks[0][k], masks[1][k], cv::NORM_INF), 0);
  }
}

TEST(Segment, MasksOfLargeFramesAreOfTheirSize) {
  const Video video = Road({1005, 75}, CV_8UC1, 8, true);
  const std::vector<cv::Mat> masks = Masks(video.frames, SegmentMethod::kFused);
  EXPECT_EQ(masks.back().size(), cv::Size(1005, 75));
  // A box that goes 125 px a frame is too fast for the flow: it is found as what is surely not the scene.
  EXPECT_GT(Iou(masks, video.truth), 0.6);
}

TEST(Segment, PlacesAreSpreadOverTheVideo) {
  EXPECT_EQ(SurveyPlaces(1), std::vector<int>({0}));
  EXPECT_EQ(SurveyPlaces(3), std::vector<int>({0, 1, 2}));
  EXPECT_EQ(SurveyPlaces(101, 5), std::vector<int>({0, 25, 50, 75, 100}));
  EXPECT_EQ(SurveyPlaces(100000).size(), 32u);
  EXPECT_THROW(SurveyPlaces(0), std::invalid_argument);
}

TEST(Segment, BadInput) {
  const cv::Mat frame = Noise({20, 20}, CV_8UC3, 1), own(20, 20, CV_8UC1, cv::Scalar(255));
  const Place alone{{frame, own}, std::vector<SteadyFrame>(kMostNeighbours)};
  SegmentSurvey survey(SegmentMethod::kFused);
  EXPECT_THROW(survey.Settings(), std::invalid_argument);
  EXPECT_THROW(survey.Add({{frame, own}, {}}, 0), std::invalid_argument);
  EXPECT_THROW(survey.Add({{frame, own.row(0)}, alone.neighbours}, 0), std::invalid_argument);
  Place mixed = alone;
  mixed.neighbours[3] = {frame.rowRange(0, 10), own.rowRange(0, 10)};
  EXPECT_THROW(survey.Add(mixed, 0), std::invalid_argument);
  survey.Add(alone, 0);
  Segmenter segmenter(survey.Settings());
  EXPECT_THROW(segmenter.Next({cv::Mat(), own}), std::invalid_argument);
  EXPECT_THROW(segmenter.Next({Noise({20, 20}, CV_8UC1, 1), own}), std::invalid_argument);
  EXPECT_THROW(segmenter.Next({Noise({21, 20}, CV_8UC3, 1), cv::Mat(20, 21, CV_8UC1)}),
               std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
