#include "sim/warp.h"

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "sim/parallel.h"

namespace shimmer::sim {
namespace {

// Weights of the pixels floor(place) - 1 .. floor(place) + 2, for the fraction t of the place.
std::array<double, 4> WeightsOf(double t, Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::kNearest:
      return {0, t < 0.5 ? 1.0 : 0.0, t < 0.5 ? 0.0 : 1.0, 0};
    case Interpolation::kBilinear:
      return {0, 1 - t, t, 0};
    case Interpolation::kBicubic:
      return {0.5 * t * ((2 - t) * t - 1), 0.5 * ((3 * t - 5) * t * t + 2), 0.5 * t * ((4 - 3 * t) * t + 1),
              0.5 * t * t * (t - 1)};
  }
  return {};
}

double SampleOf(const cv::Mat& frame, int x, int y, int channel) {
  const int i = x * frame.channels() + channel;
  switch (frame.depth()) {
    case CV_8U:
      return frame.ptr<uint8_t>(y)[i] / 255.0;
    case CV_16U:
      return frame.ptr<uint16_t>(y)[i] / 65535.0;
    default:
      return frame.ptr<float>(y)[i];
  }
}

}  // namespace

cv::Mat PrepareForWarp(const cv::Mat& clean) {
  const int depth = clean.depth();
  if ((depth != CV_8U && depth != CV_16U && depth != CV_32F) ||
      (clean.channels() != 1 && clean.channels() != 3))
    throw std::invalid_argument("frame of type " + cv::typeToString(clean.type()) +
                                ", must be of 8 bits, 16 bits or float, 1 or 3 channels");
  if (clean.channels() == 1) return clean;
  cv::Mat four(clean.size(), CV_MAKETYPE(depth, 4));
  ParallelFor(0, clean.rows, [&](int y) {
    cv::Mat row = four.row(y);
    cv::cvtColor(clean.row(y), row, cv::COLOR_RGB2RGBA);
  });
  return four;
}

double WarpDouble(const cv::Mat& frame, double x, double y, int channel, Interpolation interpolation) {
  const int whole_x = static_cast<int>(std::floor(x)), whole_y = static_cast<int>(std::floor(y));
  const auto weights_x = WeightsOf(x - whole_x, interpolation),
             weights_y = WeightsOf(y - whole_y, interpolation);
  double sum = 0;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      sum += weights_y[j] * weights_x[i] * SampleOf(frame, whole_x - 1 + i, whole_y - 1 + j, channel);
  return sum;
}

}  // namespace shimmer::sim
