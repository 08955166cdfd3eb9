#include "tests/bench/opencv_method.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace shimmer::bench {
namespace {

constexpr int kLevels = 11;

template <class Value>
void MixRow(const std::vector<cv::Mat>& levels, cv::Point first, const cv::Mat& sigma, int y, double step_px,
            cv::Mat& out) {
  const int channels = out.channels();
  Value* to = out.ptr<Value>(y);
  for (int x = 0; x < out.cols; ++x) {
    const float place = std::min(sigma.at<float>(y, x) / static_cast<float>(step_px), kLevels - 1.0f);
    const int below = std::min(static_cast<int>(place), kLevels - 2);
    const float share = place - static_cast<float>(below);
    const Value *low = levels[below].ptr<Value>(first.y + y) + (first.x + x) * channels,
                *high = levels[below + 1].ptr<Value>(first.y + y) + (first.x + x) * channels;
    for (int c = 0; c < channels; ++c)
      *to++ = cv::saturate_cast<Value>((1 - share) * static_cast<float>(low[c]) +
                                       share * static_cast<float>(high[c]));
  }
}

// Keys' cubic kernel with OpenCV's parameter, at distance d.
double CubicWeight(double d) {
  constexpr double kA = -0.75;
  d = std::abs(d);
  if (d < 1) return ((kA + 2) * d - (kA + 3)) * d * d + 1;
  return d < 2 ? ((kA * d - 5 * kA) * d + 8 * kA) * d - 4 * kA : 0;
}

}  // namespace

cv::Mat OpenCvWarp(const cv::Mat& clean, int margin_px, const cv::Mat& dx, const cv::Mat& dy) {
  cv::Mat map_x(dx.size(), CV_32F), map_y(dy.size(), CV_32F), warped;
  for (int y = 0; y < dx.rows; ++y)
    for (int x = 0; x < dx.cols; ++x) {
      map_x.at<float>(y, x) = dx.at<float>(y, x) + static_cast<float>(x + margin_px);
      map_y.at<float>(y, x) = dy.at<float>(y, x) + static_cast<float>(y + margin_px);
    }
  cv::remap(clean, warped, map_x, map_y, cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
  return warped;
}

cv::Mat OpenCvBlur(const cv::Mat& frame, int border_px, const cv::Mat& sigma, double max_sigma_px) {
  const double step_px = max_sigma_px / (kLevels - 1);
  std::vector<cv::Mat> levels{frame};
  for (int level = 1; level < kLevels; ++level) {
    cv::Mat blurred;
    cv::GaussianBlur(frame, blurred, {}, level * step_px, level * step_px, cv::BORDER_REFLECT_101);
    levels.push_back(blurred);
  }
  cv::Mat out(sigma.size(), frame.type());
  for (int y = 0; y < out.rows; ++y) {
    if (frame.depth() == CV_8U)
      MixRow<uchar>(levels, {border_px, border_px}, sigma, y, step_px, out);
    else
      MixRow<float>(levels, {border_px, border_px}, sigma, y, step_px, out);
  }
  return out;
}

double OpenCvCubicDouble(const cv::Mat& plane, double x, double y) {
  const int left = static_cast<int>(std::floor(x)) - 1, top = static_cast<int>(std::floor(y)) - 1;
  double sum = 0;
  for (int j = top; j < top + 4; ++j)
    for (int i = left; i < left + 4; ++i)
      sum += CubicWeight(y - j) * CubicWeight(x - i) * plane.at<float>(j, i);
  return sum;
}

}  // namespace shimmer::bench
