#include "restore/register.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "restore/psnr.h"
#include "tests/restore/frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

const cv::Size kSize(170, 131);

cv::Mat Flow(cv::Size size, float x, float y) { return cv::Mat(size, CV_32FC2, cv::Scalar(x, y)); }

cv::Mat MeanOf(const std::vector<WeighedFrame>& frames) {
  cv::Mat sum = cv::Mat::zeros(frames[0].frame.size(), CV_64FC1), mean;
  for (const WeighedFrame& frame : frames) cv::accumulate(frame.frame, sum);
  sum.convertTo(mean, CV_32F, 1.0 / static_cast<double>(frames.size()));
  return mean;
}

std::vector<WeighedFrame> Registered(const std::vector<WeighedFrame>& frames, RegisterParams params) {
  Registration registration(params);
  std::vector<WeighedFrame> all;
  for (const WeighedFrame& frame : frames)
    for (WeighedFrame& done : registration.Next(frame)) all.push_back(done);
  for (WeighedFrame& done : registration.Rest()) all.push_back(done);
  return all;
}

TEST(Warped, TakesPxFromWhereTheFlowPoints) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC1}) {
    const WeighedFrame in{Noise(kSize, type, 1), Noise(kSize, CV_8UC1, 2)};
    const WeighedFrame out = Warped(in, Flow(kSize, 3, -2));
    const cv::Rect inside(0, 2, kSize.width - 3, kSize.height - 2);
    EXPECT_EQ(cv::norm(out.frame(inside), in.frame(inside + cv::Point(3, -2)), cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(out.weight(inside), in.weight(inside + cv::Point(3, -2)), cv::NORM_INF), 0);
    const WeighedFrame still = Warped({in.frame, {}}, Flow(kSize, 0, 0));
    EXPECT_EQ(cv::norm(still.frame, in.frame, cv::NORM_INF), 0);
    EXPECT_TRUE(still.weight.empty());
  }
}

// A flow at half the size: its px are twice as wide, and its centres lie between those of the frame. A ramp
// and a flow that grows with x have a closed form.
TEST(Warped, EnlargesAFlow) {
  cv::Mat ramp(120, 160, CV_32FC1), flow(60, 80, CV_32FC2);
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) ramp.at<float>(y, x) = static_cast<float>(2 * x + 3 * y);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) flow.at<cv::Vec2f>(y, x) = {0.02f * static_cast<float>(x), 0.5f};
  const cv::Mat out = Warped({ramp, {}}, flow).frame;
  for (int y = 5; y < 110; ++y)
    for (int x = 5; x < 150; ++x) {
      const double by_x = 2 * 0.02 * (x / 2.0 - 0.25);
      // Places are taken to the nearest 1/32 px by OpenCV's remap: off by 1/64 px along each axis, and its
      // cubic kernel (a = -0.75) bends ramps by up to 0.04 px.
      ASSERT_NEAR(static_cast<double>(out.at<float>(y, x)), 2 * (x + by_x) + 3 * (y + 1.0),
                  5 / 64.0 + 5 * 0.04)
          << x << " " << y;
    }
}

// A scene seen through air that moves: registered frames are nearer to it, and so is their mean. The plain
// mean is the scene blurred by the tilt.
TEST(Registration, BringsFramesToTheScene) {
  std::vector<WeighedFrame> frames;
  for (uint32_t k = 0; k < 12; ++k)
    frames.push_back({SeenFrame({.size = kSize, .tilt_rms_px = 1.5, .frame = k}), {}});
  const cv::Mat scene = SeenFrame({.size = kSize});
  const auto registered = Registered(frames, {});
  ASSERT_EQ(registered.size(), frames.size());
  const double plain = Psnr(MeanOf(frames), scene), ours = Psnr(MeanOf(registered), scene);
  EXPECT_GT(ours, plain + 1);
  for (size_t k = 0; k < frames.size(); ++k)
    EXPECT_GT(Psnr(registered[k].frame, scene), Psnr(frames[k].frame, scene) + 3) << k;
}

// What all flows have in common is the reference's own error: taken off, so that the scene stays.
TEST(Registration, TakesOffTheMeanFlow) {
  std::vector<WeighedFrame> frames;
  for (uint32_t k = 0; k < 40; ++k) frames.push_back({Noise(kSize, CV_8UC3, k), {}});
  const auto same = [](const cv::Mat& from, const cv::Mat&) { return Flow(from.size(), 2.25f, -1.5f); };
  // (one keyframe: another's reference would be off too)
  const auto registered = Registered(frames, {.frames_a_keyframe = 100, .flow = same});
  ASSERT_EQ(registered.size(), frames.size());
  for (size_t k = 0; k < frames.size(); ++k)
    EXPECT_EQ(cv::norm(registered[k].frame, frames[k].frame, cv::NORM_INF), 0) << k;
}

// A new keyframe's reference is off by another amount than the one before: what its flow from that one says
// goes over to the mean flow, and the scene stays.
TEST(Registration, KeyframesDoNotMoveTheScene) {
  int asked = 0;
  float off = 1;  // of the reference, px
  const auto flow = [&](const cv::Mat& from, const cv::Mat&) {
    // Calls 0 to 9 are the first frames'; four more frames, then a keyframe's and five frames' in turn.
    const bool keyframe = asked >= 14 && (asked - 14) % 6 == 0;
    ++asked;
    if (!keyframe) return Flow(from.size(), off, 0);
    off += 0.5f;
    return Flow(from.size(), -0.5f, 0);  // old(p) = new(p - 0.5)
  };
  std::vector<WeighedFrame> frames;
  for (uint32_t k = 0; k < 40; ++k) frames.push_back({Noise(kSize, CV_8UC1, k), {}});
  const auto registered = Registered(frames, {.first_frames = 10, .frames_a_keyframe = 5, .flow = flow});
  ASSERT_EQ(registered.size(), frames.size());
  EXPECT_GT(off, 3);
  for (size_t k = 0; k < frames.size(); ++k)
    EXPECT_EQ(cv::norm(registered[k].frame, frames[k].frame, cv::NORM_INF), 0) << k;
}

// A scene that is known: frames are registered to it at once, with one flow each, and stand where it does.
// The mean of 12 tilts of 1.5 px is off by 0.43 px, which flows to the scene itself do not leave.
TEST(Registration, BringsFramesToAKnownScene) {
  std::vector<WeighedFrame> frames;
  for (uint32_t k = 0; k < 12; ++k)
    frames.push_back({SeenFrame({.size = kSize, .tilt_rms_px = 1.5, .frame = k}), {}});
  const cv::Mat scene = SeenFrame({.size = kSize});
  int flows = 0;
  const auto count = [&, flow = FineFlow()](const cv::Mat& from, const cv::Mat& to) {
    ++flows;
    return flow(from, to);
  };
  Registration registration({.scene = {scene * 255, {}}, .frames_a_keyframe = 5, .flow = count});
  const auto to_mean = Registered(frames, {});
  for (size_t k = 0; k < frames.size(); ++k) {
    const auto now = registration.Next(frames[k]);
    ASSERT_EQ(now.size(), 1u);
    EXPECT_GT(Psnr(now[0].frame, scene), Psnr(to_mean[k].frame, scene) + 1) << k;
  }
  EXPECT_EQ(flows, 12);
  EXPECT_TRUE(registration.Rest().empty());
}

// Light that fades, and more so to one side, is not taken for motion: frames are brought to the scene
// nearly as well as in its own light. (Where it is, they are 7 dB further off.)
TEST(Registration, LetsTheLightChange) {
  const cv::Mat scene = SeenFrame({.size = kSize});
  cv::Mat light(kSize, CV_32FC1);
  for (int x = 0; x < kSize.width; ++x) light.col(x) = 0.8 - 0.2 * x / kSize.width;
  Registration same({.scene = {scene * 255, {}}}), other({.scene = {scene * 255, {}}});
  for (uint32_t k = 0; k < 4; ++k) {
    const cv::Mat frame = SeenFrame({.size = kSize, .tilt_rms_px = 1.5, .frame = k});
    const cv::Mat lit = same.Next({frame, {}})[0].frame, dark = other.Next({frame.mul(light), {}})[0].frame;
    EXPECT_GT(Psnr(cv::Mat(dark / light), scene), Psnr(lit, scene) - 1) << k;
  }
}

// Where the scene is not known frames stay bit by bit, and the flow is asked for nothing there; where it is
// half trusted they move half as far.
TEST(Registration, TrustsASceneWhereItIsKnown) {
  SceneReference scene{Flat(kSize, CV_32FC1, 0.4), cv::Mat(kSize, CV_32FC1, cv::Scalar(1))};
  scene.grey.colRange(80, 120) *= 2;  // (of white 255: some range)
  const cv::Rect unknown(0, 0, 50, kSize.height), half(50, 0, 60, kSize.height);
  scene.trust(unknown) = 0, scene.trust(half) = 0.5;
  const auto flow = [&](const cv::Mat& from, const cv::Mat& to) {
    EXPECT_EQ(cv::norm(from(unknown), to(unknown), cv::NORM_INF), 0);
    EXPECT_GT(cv::norm(from.colRange(110, 170), to.colRange(110, 170), cv::NORM_INF), 20);
    return Flow(from.size(), 4, -2);
  };
  const cv::Mat frame = Noise(kSize, CV_8UC3, 1);
  const auto out = Registration({.scene = scene, .flow = flow}).Next({frame, {}});
  ASSERT_EQ(out.size(), 1u);
  const auto off = [&](cv::Rect area, cv::Point by) {
    area &= cv::Rect(0, 2, kSize.width - 4, kSize.height - 4);
    return cv::norm(out[0].frame(area), frame(area + by), cv::NORM_INF);
  };
  EXPECT_EQ(off(unknown, {0, 0}), 0);
  EXPECT_EQ(off(half, {2, -1}), 0);
  EXPECT_EQ(off({110, 0, 60, kSize.height}, {4, -2}), 0);
}

// One flow a frame, and one more for each keyframe after the first.
TEST(Registration, WorkAFrameIsBounded) {
  int flows = 0;
  const auto count = [&](const cv::Mat& from, const cv::Mat&) {
    ++flows;
    return Flow(from.size(), 0, 0);
  };
  Registration registration({.first_frames = 5, .frames_a_keyframe = 10, .flow = count});
  size_t given = 0;
  for (uint32_t k = 0; k < 60; ++k) {
    const int before = flows;
    const size_t now = registration.Next({Noise({40, 30}, CV_8UC1, k), {}}).size();
    EXPECT_EQ(now, k < 4 ? 0u : k == 4 ? 5u : 1u);
    EXPECT_LE(flows - before, k == 4 ? 5 : 2);
    given += now;
  }
  EXPECT_EQ(given, 60u);
  EXPECT_EQ(flows, 60 + 5);
}

// px that do not count are the reference's when the flow is asked for: what moves draws nothing along.
TEST(Registration, HidesWhatMovesFromTheFlow) {
  cv::Mat weight(kSize, CV_8UC1, cv::Scalar(255));
  weight(cv::Rect(40, 30, 50, 40)) = 0;
  int asked = 0;
  const auto check = [&](const cv::Mat& from, const cv::Mat& to) {
    ++asked;
    EXPECT_EQ(cv::norm(from(cv::Rect(40, 30, 50, 40)), to(cv::Rect(40, 30, 50, 40)), cv::NORM_INF), 0);
    EXPECT_GT(cv::norm(from.colRange(100, 170), to.colRange(100, 170), cv::NORM_INF), 20);
    return Flow(from.size(), 0, 0);
  };
  std::vector<WeighedFrame> frames;
  for (uint32_t k = 0; k < 4; ++k) frames.push_back({Noise(kSize, CV_8UC3, k), weight});
  for (const WeighedFrame& frame : Registered(frames, {.flow = check}))
    EXPECT_EQ(cv::norm(frame.weight, weight, cv::NORM_INF), 0);
  EXPECT_EQ(asked, 4);
}

TEST(Registration, ShortAndPlainVideos) {
  EXPECT_TRUE(Registration().Rest().empty());
  for (const cv::Size size : {cv::Size(16, 16), cv::Size(37, 17), cv::Size(1003, 21)})
    for (const int type : {CV_8UC3, CV_16UC1, CV_32FC3}) {
      const cv::Mat frame = Flat(size, type, 100);
      const auto one = Registered({{frame, {}}}, {});
      ASSERT_EQ(one.size(), 1u);
      EXPECT_LE(cv::norm(one[0].frame, frame, cv::NORM_INF), type == CV_32FC3 ? 1e-6 : 0);
    }
}

TEST(Registration, RefusesBadInput) {
  EXPECT_THROW(Registration({.first_frames = 0}), std::invalid_argument);
  EXPECT_THROW(Registration({.frames_a_keyframe = 0}), std::invalid_argument);
  EXPECT_THROW(Registration({.memory_frames = 0}), std::invalid_argument);
  EXPECT_THROW(Registration({.flow = nullptr}), std::invalid_argument);
  Registration registration;
  EXPECT_THROW(registration.Next({}), std::invalid_argument);
  EXPECT_THROW(registration.Next({cv::Mat::zeros(15, 40, CV_8UC1), {}}), std::invalid_argument);
  const SceneReference scene{Flat({40, 40}, CV_32FC1, 100), {}};
  EXPECT_THROW(Registration({.scene = scene}).Next({cv::Mat::zeros(40, 41, CV_8UC1), {}}),
               std::invalid_argument);
  Registration other;
  other.Next({cv::Mat::zeros(40, 40, CV_8UC1), {}});
  EXPECT_THROW(other.Next({cv::Mat::zeros(40, 41, CV_8UC1), {}}), std::invalid_argument);
  EXPECT_THROW(other.Next({cv::Mat::zeros(40, 40, CV_8UC3), {}}), std::invalid_argument);
  EXPECT_THROW(other.Next({cv::Mat::zeros(40, 40, CV_8UC1), cv::Mat::zeros(40, 41, CV_8UC1)}),
               std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
