#include "restore/translate.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

// Frames of distinct samples, whose every px can be told.
cv::Mat Numbered(cv::Size size, int type) {
  cv::Mat frame(size, type);
  cv::RNG random(7);
  random.fill(frame, cv::RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_16U ? 65535 : 255);
  return frame;
}

// out(p) = frame(p + s), and the nearest px where that is beyond the frame, whatever is left of it.
TEST(Translated, CopiesWholePxAndGoesOnFromTheEdge) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC3, CV_16UC4, CV_32FC1, CV_32FC3})
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(7, 5), cv::Size(33, 70)}) {
      const cv::Mat frame = Numbered(size, type);
      for (const cv::Point shift : {cv::Point(0, 0), cv::Point(2, -3), cv::Point(-6, 4), cv::Point(40, 0),
                                    cv::Point(-90, 200), cv::Point(0, -1)}) {
        const cv::Mat moved = Translated(frame, shift);
        ASSERT_EQ(moved.size(), size);
        ASSERT_EQ(moved.type(), type);
        const size_t bytes = frame.elemSize();
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x) {
            const int from_x = std::clamp(x + shift.x, 0, size.width - 1),
                      from_y = std::clamp(y + shift.y, 0, size.height - 1);
            ASSERT_EQ(std::memcmp(moved.ptr(y, x), frame.ptr(from_y, from_x), bytes), 0)
                << size << " " << shift << " " << x << " " << y;
          }
      }
    }
}

// The twin in double, from the kernel's definition, at px whose support lies on the frame or beyond it.
TEST(Translated, IsLanczosOfThreeLobes) {
  const cv::Size size(41, 67);
  const cv::Mat frame = Numbered(size, CV_32FC1);
  const auto kernel = [](double x) {
    const double a = std::numbers::pi * x;
    return x == 0 ? 1 : std::abs(x) >= 3 ? 0 : 3 * std::sin(a) * std::sin(a / 3) / (a * a);
  };
  for (const cv::Point2d shift : {cv::Point2d(0.25, -0.5), cv::Point2d(-4.75, 0), cv::Point2d(11, 30.125)}) {
    const cv::Mat moved = Translated(frame, shift);
    double worst = 0;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const double at_x = x + shift.x, at_y = y + shift.y;
        double sum = 0, weights = 0;
        for (int j = cvFloor(at_y) - 2; j <= cvFloor(at_y) + 3; ++j)
          for (int i = cvFloor(at_x) - 2; i <= cvFloor(at_x) + 3; ++i) {
            const double weight = kernel(i - at_x) * kernel(j - at_y);
            weights += weight;
            sum +=
                weight * frame.at<float>(std::clamp(j, 0, size.height - 1), std::clamp(i, 0, size.width - 1));
          }
        worst = std::max(worst, std::abs(moved.at<float>(y, x) - sum / weights));
      }
    EXPECT_LT(worst, 1e-3) << shift;  // of 255, in float32
  }
}

// A picture without detail below 9 px is found again to 1/200 of its contrast; integers are rounded once.
TEST(Translated, IsTheSceneAtTheShiftedPlace) {
  const cv::Size size(160, 90);
  const cv::Point2d shift(3.4, -7.7);
  const cv::Mat seen = SeenFrame({.size = size, .shift = shift}), steady = SeenFrame({.size = size});
  const cv::Rect own = SeenArea(size, shift), inner(own.x + 3, own.y + 3, own.width - 6, own.height - 6);
  EXPECT_EQ(own, cv::Rect(0, 8, 156, 82));
  EXPECT_LT(cv::norm(Translated(seen, shift)(inner), steady(inner), cv::NORM_INF), 0.005);
  cv::Mat bytes, expected;
  seen.convertTo(bytes, CV_8U, 150, 50);
  steady.convertTo(expected, CV_32F, 150, 50);
  cv::Mat moved;
  Translated(bytes, shift).convertTo(moved, CV_32F);
  EXPECT_LT(cv::norm(moved(inner), expected(inner), cv::NORM_INF),
            2.3);  // 0.5 in, at most 1.3 times that, 0.5 out, 1
}

TEST(Translated, ConstantsStayAndBandsDoNotShow) {
  for (const int type : {CV_8UC3, CV_16UC1, CV_32FC3}) {
    const cv::Mat frame(200, 30, type, cv::Scalar::all(CV_MAT_DEPTH(type) == CV_32F ? 0.75 : 255));
    EXPECT_LT(cv::norm(Translated(frame, {0.3, -5.6}), frame, cv::NORM_INF), 1e-6);
  }
}

TEST(Translated, RefusesWhatItCanNotMove) {
  const cv::Mat frame = Numbered({8, 8}, CV_8UC1);
  EXPECT_THROW(Translated({}, {}), std::invalid_argument);
  EXPECT_THROW(Translated(cv::Mat(8, 8, CV_64F, cv::Scalar(0)), {}), std::invalid_argument);
  EXPECT_THROW(Translated(frame, {std::numeric_limits<double>::quiet_NaN(), 0}), std::invalid_argument);
  EXPECT_THROW(Translated(frame, {0, std::numeric_limits<double>::infinity()}), std::invalid_argument);
}

TEST(SeenArea, IsWhereTheShiftedPxIsOnTheFrame) {
  const cv::Size size(30, 20);
  for (const cv::Point2d shift :
       {cv::Point2d(0, 0), cv::Point2d(4, -3), cv::Point2d(4.5, -3.25), cv::Point2d(-0.5, 0.5),
        cv::Point2d(29, 19), cv::Point2d(30, 0), cv::Point2d(-1000, 2)}) {
    const cv::Rect seen = SeenArea(size, shift);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const cv::Point2d at = cv::Point2d(x, y) + shift;
        EXPECT_EQ(seen.contains({x, y}), at.x >= 0 && at.y >= 0 && at.x <= 29 && at.y <= 19)
            << shift << x << " " << y;
      }
  }
}

}  // namespace
}  // namespace shimmer::restore
