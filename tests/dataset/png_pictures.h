// Pictures to write as PNG: samples of every kind, from what deflates to nothing to what can't be deflated.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <string>
#include <vector>

namespace shimmer::dataset {

enum class Content { kConstant, kGradient, kPhotograph, kNoise };
inline constexpr Content kContents[] = {Content::kConstant, Content::kGradient, Content::kPhotograph,
                                        Content::kNoise};

inline const std::vector<int> kPngTypes = {CV_8UC1,  CV_8UC2,  CV_8UC3,  CV_8UC4,
                                           CV_16UC1, CV_16UC2, CV_16UC3, CV_16UC4};

// In [0, 1]. A photograph: edges between soft shades, and a little grain.
inline double Shade(Content content, int x, int y, int channel, double grain) {
  switch (content) {
    case Content::kConstant:
      return 0.3 + 0.2 * channel;
    case Content::kGradient:
      return std::fmod((x + 2 * y + 40 * channel) / 300.0, 1);
    case Content::kPhotograph: {
      const bool left = std::hypot(x % 97 - 40, y % 83 - 30) < 25;
      return 0.4 + (left ? 0.25 : 0) + 0.2 * std::sin(0.05 * x + 0.03 * y + channel) + 0.03 * (grain - 0.5);
    }
    default:
      return grain;
  }
}

inline cv::Mat PngPicture(Content content, cv::Size size, int type) {
  cv::Mat samples(size, type);
  std::mt19937 generator(static_cast<uint32_t>(size.width * 31 + size.height));
  const int channels = samples.channels();
  for (int y = 0; y < size.height; ++y)
    for (int i = 0; i < size.width * channels; ++i) {
      const double shade = Shade(content, i / channels, y, i % channels, generator() / 4294967296.0);
      if (samples.depth() == CV_8U)
        samples.ptr<uint8_t>(y)[i] = static_cast<uint8_t>(256 * shade);
      else
        samples.ptr<uint16_t>(y)[i] = static_cast<uint16_t>(65536 * shade);
    }
  return samples;
}

// "CV_8UC3 251x13"
inline std::string NameOf(const cv::Mat& samples) {
  return cv::typeToString(samples.type()) + " " + std::to_string(samples.cols) + "x" +
         std::to_string(samples.rows);
}

// Calls f(samples) for every content and type, in sizes small, thin and odd; one picture of each type is
// large.
template <class F>
void ForEachPngPicture(const F& f) {
  std::vector<cv::Size> sizes = {{1, 1}, {1, 29}, {29, 1}, {251, 13}, {13, 251}, {64, 64}};
  for (int side = 2; side <= 17; ++side) sizes.push_back({side, 19 - side});
  for (const int type : kPngTypes) {
    for (const Content content : kContents)
      for (const cv::Size size : sizes) f(PngPicture(content, size, type));
    f(PngPicture(Content::kPhotograph, {1024, 1024}, type));
  }
}

}  // namespace shimmer::dataset
