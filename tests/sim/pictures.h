// Analytic pictures for tests.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>

namespace shimmer::sim {

// A sum of sines that can be evaluated anywhere: periods of 14 px and more, values in [0.1, 0.9].
inline double SumOfSines(double x, double y, int channel = 0) {
  return 0.5 + 0.15 * std::sin(0.31 * x + 0.17 * y + channel) + 0.15 * std::sin(-0.21 * x + 0.4 * y) +
         0.1 * std::sin(0.05 * x - 0.07 * y + 2 * channel);
}

// Pixel (x, y) of the result is f(x - halo_px, y - halo_px, channel).
template <class F>
cv::Mat Picture(cv::Size size, int halo_px, int channels, const F& f) {
  cv::Mat image(size.height + 2 * halo_px, size.width + 2 * halo_px, CV_32FC(channels));
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      for (int c = 0; c < channels; ++c)
        image.ptr<float>(y)[x * channels + c] = static_cast<float>(f(x - halo_px, y - halo_px, c));
  return image;
}

inline cv::Mat SinesPicture(cv::Size size, int halo_px, int channels = 3) {
  return Picture(size, halo_px, channels, [](int x, int y, int c) { return SumOfSines(x, y, c); });
}

inline bool SameBytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

}  // namespace shimmer::sim
