#include "restore/blend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "restore/membrane.h"
#include "tests/restore/frames.h"

namespace shimmer::restore {
namespace {

const cv::Size kSize(97, 61);

// Masks of every kind that are asked of blending, CV_8UC1 of 0 and 255.
std::vector<std::pair<std::string, cv::Mat>> Masks() {
  std::vector<std::pair<std::string, cv::Mat>> masks;
  const auto add = [&](const char* name) -> cv::Mat& {
    return masks.emplace_back(name, cv::Mat::zeros(kSize, CV_8UC1)).second;
  };
  add("one px").at<uint8_t>(30, 40) = 255;
  add("corner px").at<uint8_t>(0, 0) = 255;
  cv::circle(add("disc"), {48, 30}, 25, 255, cv::FILLED);
  add("box at the edge")(cv::Rect(60, 20, 37, 41)) = 255;
  add("from edge to edge")(cv::Rect(10, 0, 50, 61)) = 255;
  cv::Mat& all_but_one = add("all but one px");
  all_but_one = 255;
  all_but_one.at<uint8_t>(33, 71) = 0;
  cv::circle(add("ring"), {48, 30}, 20, 255, 9);
  cv::Mat& several = add("several");
  several(cv::Rect(3, 3, 20, 30)) = 255;
  several(cv::Rect(24, 10, 30, 5)) = 255;  // a px between them
  cv::circle(several, {80, 40}, 15, 255, cv::FILLED);
  cv::randu(add("specks"), 0, 2);
  masks.back().second *= 255;
  cv::line(add("thread"), {0, 60}, {96, 0}, 255, 1);
  for (int x = 0; x < 97; x += 2) add("comb").col(x) = 255, masks.back().second.row(0) = 255;
  return masks;
}

// The same equations in double by sweeps of Gauss-Seidel with over-relaxation until nothing changes. They
// start at the mean around the mask: a mask that one px holds would take them forever.
cv::Mat DirectMembrane(const cv::Mat& inside, const cv::Mat& around) {
  cv::Mat u;
  around.convertTo(u, CV_64F);
  cv::Mat beside;
  cv::dilate(inside, beside, cv::getStructuringElement(cv::MORPH_CROSS, {3, 3}));
  u.setTo(cv::mean(around, beside & ~inside), inside);
  double change = 1;
  while (change > 1e-7) {
    change = 0;
    for (int y = 0; y < u.rows; ++y)
      for (int x = 0; x < u.cols; ++x) {
        if (inside.at<uint8_t>(y, x) == 0) continue;
        double sum = 0;
        int count = 0;
        for (const cv::Point d : {cv::Point(-1, 0), {1, 0}, {0, -1}, {0, 1}}) {
          if (!cv::Rect({0, 0}, u.size()).contains(cv::Point(x, y) + d)) continue;
          sum += u.at<double>(y + d.y, x + d.x), ++count;
        }
        double& value = u.at<double>(y, x);
        const double by = 1.9 * (sum / count - value);
        value += by;
        change = std::max(change, std::abs(by));
      }
  }
  return u;
}

double Discrepancy(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

// Against a direct solution, the values around being white noise of the whole range: harder than any video.
TEST(Membrane, IsTheDirectSolution) {
  const cv::Mat around = Noise(kSize, CV_8UC1, 5);
  for (const auto& [name, mask] : Masks()) {
    const cv::Mat truth = DirectMembrane(mask, around);
    const Membrane membrane(mask);
    const auto found = membrane.Solve(
        [&](cv::Point px) {
          EXPECT_EQ(mask.at<uint8_t>(px), 0);
          return Sample4{{static_cast<float>(around.at<uint8_t>(px)), 7, 0, 0}};
        },
        0.05);
    double most = 0;
    size_t count = 0;
    for (const CellRun& run : membrane.runs())
      for (int x = run.begin; x < run.end; ++x, ++count) {
        const Sample4& value = found[static_cast<size_t>(run.first + x - run.begin)];
        most = std::max(most, std::abs(static_cast<double>(value.v[0]) - truth.at<double>(run.y, x)));
        EXPECT_NEAR(static_cast<double>(value.v[1]), 7, 1e-4) << name;
      }
    EXPECT_EQ(count, static_cast<size_t>(cv::countNonZero(mask))) << name;
    EXPECT_LT(most, 0.05) << name;
  }
}

// Closed form: around a mask that is a disc in a plane, the membrane is the plane.
TEST(Membrane, PlanesStayPlanes) {
  cv::Mat mask = cv::Mat::zeros(400, 500, CV_8UC1);
  cv::circle(mask, {250, 200}, 180, 255, cv::FILLED);
  cv::circle(mask, {200, 180}, 20, 0, cv::FILLED);
  const Membrane membrane(mask);
  const auto plane = [](double x, double y) { return 20 + 0.25 * x - 0.125 * y; };
  const auto found = membrane.Solve(
      [&](cv::Point px) {
        return Sample4{{static_cast<float>(plane(px.x, px.y)), 0, 0, 0}};
      },
      0.02);
  for (const CellRun& run : membrane.runs())
    for (int x = run.begin; x < run.end; ++x)
      ASSERT_NEAR(static_cast<double>(found[static_cast<size_t>(run.first + x - run.begin)].v[0]),
                  plane(x, run.y), 0.02);
}

// A frame that is the background and an offset, in the mask: the result is the background.
TEST(Blended, AnOffsetVanishes) {
  for (const int type : {CV_32FC1, CV_32FC3})
    for (const auto& [name, mask] : Masks()) {
      const cv::Mat background = Noise(kSize, type, 1);
      const cv::Mat frame = background + cv::Scalar(0.04, -0.06, 0.05);
      EXPECT_LT(Discrepancy(Blended(frame, background, mask), background) * 255, 1e-3) << name;
    }
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3}) {
    const cv::Mat background = Noise(kSize, type, 1) * 0.5 + cv::Scalar::all(10);
    for (const auto& [name, mask] : Masks())
      EXPECT_EQ(Discrepancy(Blended(background + cv::Scalar(15, 7, -9), background, mask), background), 0)
          << name;
  }
}

// Two objects, each with its own offset: both vanish.
TEST(Blended, OffsetsOfSeveralObjectsVanish) {
  cv::Mat mask = cv::Mat::zeros(90, 200, CV_8UC1);
  const cv::Rect left(0, 0, 100, 90), right(100, 0, 100, 90);
  cv::circle(mask, {50, 45}, 30, 255, cv::FILLED);
  cv::circle(mask, {150, 45}, 40, 255, cv::FILLED);
  const cv::Mat background = Noise(mask.size(), CV_32FC3, 1);
  cv::Mat frame = background.clone();
  frame(left) += cv::Scalar::all(0.02);
  frame(right) -= cv::Scalar::all(0.06);
  EXPECT_LT(Discrepancy(Blended(frame, background, mask), background) * 255, 0.1);
}

// Inside of the mask, its rim included, the result's Laplacian is the frame's; around it lies the background.
TEST(Blended, GradientsOfTheForegroundStay) {
  const cv::Mat background = Noise(kSize, CV_32FC3, 2),
                frame = background + 0.1 * Noise(kSize, CV_32FC3, 1) - cv::Scalar::all(0.05);
  for (const auto& [name, mask] : Masks()) {
    const cv::Mat blended = Blended(frame, background, mask);
    const cv::Mat stays = blended.clone();
    background.copyTo(stays, mask == 0);
    EXPECT_EQ(Discrepancy(stays, blended), 0) << name;
    cv::Mat found, asked;
    cv::Laplacian(blended, found, CV_32F, 1, 1, 0, cv::BORDER_REPLICATE);
    cv::Laplacian(frame, asked, CV_32F, 1, 1, 0, cv::BORDER_REPLICATE);
    cv::Mat error;
    cv::absdiff(found, asked, error);
    error = error.reshape(1, kSize.height);
    cv::Mat samples;
    cv::resize(mask, samples, {kSize.width * 3, kSize.height}, 0, 0, cv::INTER_NEAREST);
    error.setTo(0, samples == 0);
    EXPECT_LT(cv::norm(error, cv::NORM_INF) * 255, 0.2) << name;  // five values, each off by some 0.01
  }
}

// Rounded once: within 1/2 and the solver's 0.1 of what floats give.
TEST(Blended, RoundsOnce) {
  const cv::Mat mask = Masks()[2].second;
  for (const int depth : {CV_8U, CV_16U}) {
    const double white = WhiteOf(depth);
    const cv::Mat frame = Noise(kSize, CV_MAKETYPE(depth, 3), 1) * 0.05 + cv::Scalar::all(0.3 * white),
                  background = Noise(kSize, CV_MAKETYPE(depth, 3), 2) * 0.05 + cv::Scalar::all(0.3 * white);
    cv::Mat floats, behind, exact;
    frame.convertTo(floats, CV_32F, 1 / white);
    background.convertTo(behind, CV_32F, 1 / white);
    Blended(floats, behind, mask).convertTo(exact, CV_32F, white);
    cv::Mat found;
    Blended(frame, background, mask).convertTo(found, CV_32F);
    EXPECT_LT(Discrepancy(found, exact), 0.5 + 0.1 * white / 255);
  }
}

TEST(Blended, MasksOfNothingAndOfEverything) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_32FC1})
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(7, 1), cv::Size(33, 20)}) {
      const cv::Mat frame = Noise(size, type, 1), background = Noise(size, type, 2);
      EXPECT_EQ(Discrepancy(Blended(frame, background, cv::Mat::zeros(size, CV_8UC1)), background), 0);
      EXPECT_EQ(Discrepancy(Blended(frame, background, cv::Mat(size, CV_8UC1, cv::Scalar(255))), frame), 0);
    }
}

// An edge that is unsure: no step from px to px is larger than the mask's own step and the two pictures'
// ones.
TEST(Blended, FeathersByTheMask) {
  const cv::Mat frame(40, 100, CV_32FC1, cv::Scalar(0.25)), background(40, 100, CV_32FC1, cv::Scalar(0.2));
  cv::Mat mask(40, 100, CV_8UC1), lifted = frame.clone();
  for (int x = 0; x < 100; ++x) mask.col(x) = std::clamp(20 * (x - 30), 0, 255);
  lifted.colRange(60, 100) += 0.1;  // the object
  const cv::Mat blended = Blended(lifted, background, mask);
  // To the left the offset has vanished; the object stands out by its own 0.1.
  for (int x = 0; x < 60; ++x) EXPECT_NEAR(static_cast<double>(blended.at<float>(20, x)), 0.2, 1e-3) << x;
  for (int x = 60; x < 100; ++x) EXPECT_NEAR(static_cast<double>(blended.at<float>(20, x)), 0.3, 1e-3) << x;
  // Half sure: halfway between the background and the frame that the membrane has lifted.
  mask = cv::Mat::zeros(40, 100, CV_8UC1);
  mask(cv::Rect(50, 20, 1, 1)) = 51;
  cv::Mat speck = background.clone();
  speck.at<float>(20, 50) += 0.5f;
  EXPECT_NEAR(static_cast<double>(Blended(speck, background, mask).at<float>(20, 50)), 0.2 + 0.5 / 5, 1e-6);
}

// Half of a bright box, in light that is a little brighter than the background's: the box keeps its colour,
// as the membrane meets the light above and below and not the other half.
TEST(Blended, WhatTheMaskCutsKeepsItsColour) {
  const cv::Mat background(60, 100, CV_32FC3, cv::Scalar(0.2, 0.3, 0.4));
  cv::Mat frame = background + cv::Scalar::all(0.03), mask = cv::Mat::zeros(frame.size(), CV_8UC1);
  frame(cv::Rect(30, 20, 40, 20)) = cv::Scalar(0.9, 0.3, 0.6);
  mask(cv::Rect(26, 16, 24, 28)) = 255;
  const cv::Mat blended = Blended(frame, background, mask);
  const cv::Rect left_half(30, 20, 20, 20);
  cv::Mat off;
  cv::absdiff(blended(left_half), frame(left_half), off);
  EXPECT_LE(cv::norm(off, cv::NORM_INF), 0.03 + 1e-4);
  EXPECT_LT(Discrepancy(blended(cv::Rect(26, 16, 4, 28)), background(cv::Rect(26, 16, 4, 28))), 0.03);
}

TEST(Blended, WhatIsNotFiniteDoesNotSpread) {
  const cv::Mat background = Noise(kSize, CV_32FC1, 2);
  cv::Mat frame = background.clone();
  const cv::Mat mask = Masks()[2].second;
  for (int x = 0; x < 97; ++x)
    if (mask.at<uint8_t>(30, x) == 0) frame.at<float>(30, x) = NAN;
  EXPECT_LT(Discrepancy(Blended(frame, background, mask), background), 1e-6);
}

TEST(Blended, RefusesBadInput) {
  const cv::Mat frame = Noise(kSize, CV_8UC3, 1), mask = cv::Mat::zeros(kSize, CV_8UC1);
  EXPECT_THROW(Blended({}, {}, {}), std::invalid_argument);
  EXPECT_THROW(Blended(frame, Noise(kSize, CV_8UC1, 1), mask), std::invalid_argument);
  EXPECT_THROW(Blended(frame, frame.rowRange(0, 60), mask), std::invalid_argument);
  EXPECT_THROW(Blended(frame, frame, mask.rowRange(0, 60)), std::invalid_argument);
  EXPECT_THROW(Blended(frame, frame, frame), std::invalid_argument);
  const cv::Mat two(kSize, CV_8UC2, cv::Scalar::all(0));
  EXPECT_THROW(Blended(two, two, mask), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::restore
