// Marks of moving scenes lie on the right pixels, and only where there is truth of them.
#include "sim/app/scene_marks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/app/sheet.h"

namespace shimmer::app {
namespace {

constexpr int kRadius = 20;
const cv::Size kFrame(120, 90);
const cv::Point kCentre(50, 40);

// Coverage of a disc.
cv::Mat Disc(cv::Size size = kFrame, cv::Point centre = kCentre, double radius = kRadius) {
  cv::Mat mask(size, CV_32FC1);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      mask.at<float>(y, x) =
          static_cast<float>(std::clamp(radius - std::hypot(x - centre.x, y - centre.y) + 0.5, 0.0, 1.0));
  return mask;
}

cv::Mat Grey(cv::Size size = kFrame) { return cv::Mat(size, CV_8UC3, cv::Scalar::all(128)); }

cv::Mat Where(const cv::Mat& picture, const cv::Vec3b& colour) {
  cv::Mat same;
  cv::inRange(picture, colour, colour, same);
  return same;
}

TEST(SceneMarks, OutlineIsTheOutermostCoveredPixels) {
  for (const cv::Point by : {cv::Point(0, 0), cv::Point(7, -5), cv::Point(-45, 3)}) {
    cv::Mat shown = Grey();
    DrawOutline(shown, Disc(), cv::Point2d(by) + cv::Point2d(0.3, -0.4));  // rounded
    const cv::Mat green = Where(shown, kOutline), shadow = Where(shown, kOutlineShadow);
    for (int y = 0; y < shown.rows; ++y)
      for (int x = 0; x < shown.cols; ++x) {
        const cv::Point from = cv::Point(x, y) - by;
        const auto covered = [&](int dx, int dy) {
          return std::hypot(from.x + dx - kCentre.x, from.y + dy - kCentre.y) <= kRadius;
        };
        const bool edge =
            covered(0, 0) && !(covered(-1, 0) && covered(1, 0) && covered(0, -1) && covered(0, 1));
        EXPECT_EQ(green.at<uchar>(y, x) != 0, edge) << by << " " << x << " " << y;
        EXPECT_FALSE(shadow.at<uchar>(y, x) != 0 && covered(0, 0)) << x << " " << y;
        if (edge && x > 0 && x + 1 < shown.cols) {  // with a dark pixel beside it
          const cv::Rect around(x - 1, y - 1, 3, 3);
          EXPECT_GT(cv::countNonZero(shadow(around)), 0) << by << " " << x << " " << y;
        }
      }
  }
}

TEST(SceneMarks, OutlineHasNoLineWhereTheFrameEnds) {
  cv::Mat shown = Grey();
  DrawOutline(shown, cv::Mat::ones(kFrame, CV_32FC1), {9, 4});  // what comes in is not known
  EXPECT_EQ(cv::norm(shown, Grey(), cv::NORM_INF), 0);
  for (const cv::Point2d& far : {cv::Point2d(500, 0), cv::Point2d(0, -1e300),
                                 cv::Point2d(std::numeric_limits<double>::infinity(), 0)}) {
    DrawOutline(shown, Disc(), far);
    EXPECT_EQ(cv::norm(shown, Grey(), cv::NORM_INF), 0) << far;
  }
}

// Line and shift are those of the size that is shown; what is small does not vanish.
TEST(SceneMarks, OutlineOfOtherSizes) {
  cv::Mat large = Grey(kFrame * 2), small = Grey(kFrame / 2), speck = Grey(kFrame / 10);
  DrawOutline(large, Disc(), {4, 0});
  DrawOutline(small, Disc(), {4, 0});
  DrawOutline(speck, Disc(kFrame, kCentre, 0.4), {0, 0});
  const auto box = [](const cv::Mat& shown) { return cv::boundingRect(Where(shown, kOutline)); };
  EXPECT_EQ(box(large), cv::Rect(2 * (50 - 20 + 4), 2 * (40 - 20), 82, 82));
  EXPECT_EQ(box(small), cv::Rect((50 - 20 + 4) / 2, (40 - 20) / 2, 21, 21));
  EXPECT_EQ(box(speck), cv::Rect(5, 4, 1, 1));
}

TEST(SceneMarks, InsetIsOnlyWhereTheCameraMoves) {
  SceneMarks marks{.turb_shake_px = cv::Point2d(), .path_px = {{0, 0}, {0, 0}}, .place = 1};
  cv::Mat shown = Grey();
  MarkTurb(shown, marks);
  EXPECT_EQ(cv::norm(shown, Grey(), cv::NORM_INF), 0);
  EXPECT_EQ(marks.Label(), "");

  marks.path_px = {{0, 0}, {3, 4}};
  MarkClean(shown, marks);
  EXPECT_EQ(cv::norm(shown, Grey(), cv::NORM_INF), 0);
  MarkTurb(shown, marks);
  EXPECT_EQ(marks.Label(), "shake up to 5 px");
  const cv::Rect inset = ShakeInsetArea(kFrame);
  cv::Mat outside = shown.clone();
  outside(inset).setTo(cv::Scalar::all(128));
  EXPECT_EQ(cv::norm(outside, Grey(), cv::NORM_INF), 0);
  // The dot is right of the middle and below it: at 3 and 4 of 5 to the rim.
  const cv::Rect dot = cv::boundingRect(Where(shown(inset), kShakePlace));
  const cv::Point2d middle((inset.width - 1) / 2.0, (inset.height - 1) / 2.0),
      off = cv::Point2d(dot.x + (dot.width - 1) / 2.0, dot.y + (dot.height - 1) / 2.0) - middle;
  const double reach_px = middle.x - 5;
  EXPECT_NEAR(off.x, 0.6 * reach_px, 1);
  EXPECT_NEAR(off.y, 0.8 * reach_px, 1);

  cv::Mat tiny = Grey({20, 20});
  MarkTurb(tiny, marks);
  EXPECT_EQ(cv::norm(tiny, Grey({20, 20}), cv::NORM_INF), 0);
}

TEST(SceneMarks, LieOnTheirCellsOfASheet) {
  const cv::Mat frame(kFrame, CV_32FC3, cv::Scalar::all(0.5));
  SheetRow row{"", frame, frame, {}, {}};
  const cv::Mat bare = DrawSheet({&row, 1}, 120);
  row.marks.emplace();
  EXPECT_EQ(cv::norm(DrawSheet({&row, 1}, 120), bare, cv::NORM_INF), 0);
  row.marks = SceneMarks{.mask = Disc(), .clean_shake_px = cv::Point2d(), .turb_shake_px = cv::Point2d(6, 2)};
  const cv::Mat page = DrawSheet({&row, 1}, 120);
  ASSERT_EQ(page.size(), bare.size());
  const cv::Mat green = Where(page, kOutline);
  const int half = page.cols / 4;  // of four columns, the first holds the clean one
  const cv::Rect clean = cv::boundingRect(green.colRange(0, half)),
                 turb = cv::boundingRect(green.colRange(half, page.cols));
  EXPECT_EQ(clean.size(), cv::Size(41, 41));
  EXPECT_EQ(turb.size(), cv::Size(41, 41));
  EXPECT_EQ(turb.y - clean.y, 2);

  row.marks->turb_shake_px.reset();  // not known
  EXPECT_EQ(cv::countNonZero(Where(DrawSheet({&row, 1}, 120), kOutline)), cv::countNonZero(green) / 2);
}

TEST(SceneMarks, RefuseBadInput) {
  cv::Mat shown = Grey(), grey(kFrame, CV_8UC1);
  EXPECT_THROW(DrawOutline(grey, Disc(), {}), std::invalid_argument);
  EXPECT_THROW(DrawOutline(shown, Grey(), {}), std::invalid_argument);
  const std::vector<cv::Point2d> path = {{0, 0}, {1, 1}};
  EXPECT_THROW(DrawShakeInset(shown, path, 2), std::invalid_argument);
  EXPECT_THROW(DrawShakeInset(grey, path, 0), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::app
