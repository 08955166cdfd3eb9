#include "sim/colour.h"

#include <algorithm>

#include "noise/portable_math.h"

namespace shimmer::sim {
namespace {

double Power(double base, double exponent) { return noise::Exp(exponent * noise::Log(base)); }

float Decode(float v) {
  return v <= 0.04045f ? v / 12.92f : static_cast<float>(Power((v + 0.055) / 1.055, 2.4));
}

float Encode(float v) {
  v = std::max(v, 0.0f);
  return v <= 0.0031308f ? v * 12.92f : static_cast<float>(1.055 * Power(v, 1 / 2.4) - 0.055);
}

template <class F>
cv::Mat Map(const cv::Mat& image, const F& f) {
  cv::Mat mapped(image.size(), image.type());
  for (int y = 0; y < image.rows; ++y) {
    const float* from = image.ptr<float>(y);
    std::transform(from, from + image.cols * image.channels(), mapped.ptr<float>(y), f);
  }
  return mapped;
}

}  // namespace

cv::Mat DecodeSrgb(const cv::Mat& stored) { return Map(stored, Decode); }
cv::Mat EncodeSrgb(const cv::Mat& linear) { return Map(linear, Encode); }

}  // namespace shimmer::sim
