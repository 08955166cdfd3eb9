#include "restore/translate.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace shimmer::restore {
namespace {

constexpr int kLobes = 3;
constexpr double kSteps = 1024;  // of a px
constexpr int kBand = 64;        // rows that one thread takes at a time

// A shift in whole px and the rest, in [0, 1).
struct Parts {
  int whole;
  double rest;
};

Parts PartsOf(double shift_px) {
  const double rounded = std::round(shift_px * kSteps) / kSteps, whole = std::floor(rounded);
  return {static_cast<int>(whole), rounded - whole};
}

double Sinc(double x) { return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); }

// Weights of the px from -2 to 3 for the place `rest` right of px 0.
cv::Mat Weights(double rest) {
  if (rest == 0) return cv::Mat::ones(1, 1, CV_32FC1);
  cv::Mat weights(1, 2 * kLobes, CV_64FC1);
  for (int i = 0; i < 2 * kLobes; ++i) {
    const double x = i - (kLobes - 1) - rest;
    weights.at<double>(i) = Sinc(x) * Sinc(x / kLobes);
  }
  cv::Mat result;
  weights.convertTo(result, CV_32F, 1 / cv::sum(weights)[0]);
  return result;
}

// What a window from `first` of `count` px sees of a line of `length` px: at least its nearest px.
struct Window {
  cv::Range seen;
  int before, after;  // px of the window on either side of them

  Window(int first, int count, int length)
      : seen(std::clamp(first, 0, length - 1), std::clamp(first + count, 1, length)),
        before(std::clamp(-first, 0, count - 1)),
        after(count - before - seen.size()) {}
};

// A copy of that part of the frame, its edges going on beyond it.
cv::Mat Part(const cv::Mat& frame, cv::Rect area) {
  const Window x(area.x, area.width, frame.cols), y(area.y, area.height, frame.rows);
  cv::Mat part;
  cv::copyMakeBorder(frame(y.seen, x.seen), part, y.before, y.after, x.before, x.after,
                     cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
  return part;
}

void RequireFrame(const cv::Mat& frame, cv::Point2d shift_px) {
  if (frame.empty()) throw std::invalid_argument("Translated: the frame is empty");
  if (frame.depth() != CV_8U && frame.depth() != CV_16U && frame.depth() != CV_32F)
    throw std::invalid_argument("Translated: frame must be CV_8U, CV_16U or CV_32F");
  // (also what can't be counted in px)
  if (!(std::abs(shift_px.x) < 1e8 && std::abs(shift_px.y) < 1e8))
    throw std::invalid_argument("Translated: shift must be finite, and less than 1e8 px");
}

}  // namespace

cv::Mat Translated(const cv::Mat& frame, cv::Point2d shift_px) {
  RequireFrame(frame, shift_px);
  const Parts x = PartsOf(shift_px.x), y = PartsOf(shift_px.y);
  if (x.rest == 0 && y.rest == 0) return Part(frame, {{x.whole, y.whole}, frame.size()});
  // With as much around it as the kernel reaches.
  const cv::Point around(kLobes, kLobes);
  const cv::Mat wide =
      Part(frame, {cv::Point(x.whole, y.whole) - around, frame.size() + cv::Size(around * 2)});
  const cv::Mat moved = wide({around, frame.size()});
  const cv::Mat along_x = Weights(x.rest), along_y = Weights(y.rest);
  const cv::Point anchor(x.rest == 0 ? 0 : kLobes - 1, y.rest == 0 ? 0 : kLobes - 1);
  cv::Mat out(frame.size(), frame.type());
  tbb::parallel_for(0, (frame.rows + kBand - 1) / kBand, [&](int band) {
    const cv::Range rows(band * kBand, std::min((band + 1) * kBand, frame.rows));
    cv::Mat part = out.rowRange(rows);  // the filter reads what lies around its rows
    cv::sepFilter2D(moved.rowRange(rows), part, -1, along_x, along_y, anchor, 0, cv::BORDER_REPLICATE);
  });
  return out;
}

cv::Rect SeenArea(cv::Size size, cv::Point2d shift_px) {
  const auto span = [](int length, double shift) {
    const Parts parts = PartsOf(std::clamp(shift, -1e8, 1e8));
    const int first = std::max(0, -parts.whole);
    const int end = std::min(length, length - parts.whole - (parts.rest > 0 ? 1 : 0));
    return cv::Range(first, std::max(first, end));
  };
  const cv::Range x = span(size.width, shift_px.x), y = span(size.height, shift_px.y);
  return {x.start, y.start, x.size(), y.size()};
}

}  // namespace shimmer::restore
