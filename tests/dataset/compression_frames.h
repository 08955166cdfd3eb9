// What the tests of compression share: frames to compress, and how much they have changed.
#pragma once

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/dataset/compression.h"
#include "tests/dataset/png_pictures.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {

inline const std::vector<int> kTypes = {CV_8UC1, CV_8UC3};
inline const std::vector<cv::Size> kSizes = {{1, 1}, {2, 3}, {1, 40}, {40, 1}, {17, 5}, {16, 16}, {64, 48}};

inline double MeanError(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total() * a.channels());
}
inline double MaxError(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

// Shades so soft that little is lost with every second row and column of the colour.
inline cv::Mat Soft(cv::Size size, int type) {
  cv::Mat frame(size, type);
  const int channels = frame.channels();
  for (int y = 0; y < size.height; ++y)
    for (int i = 0; i < size.width * channels; ++i)
      frame.ptr(y)[i] = static_cast<uint8_t>(128.5 + 70 * std::sin(0.05 * (i / channels) + i % channels) *
                                                         std::cos(0.04 * y + i % channels));
  return frame;
}

// Columns of two colours in turn, of the same luma by BT.601 (JPEG) to 1 level.
inline cv::Mat Stripes() {
  cv::Mat stripes(48, 64, CV_8UC3, cv::Scalar(200, 60, 60));
  for (int x = 0; x < stripes.cols; x += 2) stripes.col(x).setTo(cv::Scalar(60, 131, 60));
  return stripes;
}

// What moves: parts of a photograph, each a little aside from the one before.
inline std::vector<cv::Mat> Clip(cv::Size size, int type, int count) {
  const cv::Mat scene = PngPicture(Content::kPhotograph, {size.width + 2 * count, size.height + count}, type);
  std::vector<cv::Mat> frames;
  for (int i = 0; i < count; ++i) frames.push_back(scene(cv::Rect({2 * i, i}, size)));
  return frames;
}

inline std::vector<cv::Mat> ClipThroughH264(const std::vector<cv::Mat>& frames, double crf) {
  H264Stream stream(frames[0].size(), frames[0].channels(), crf);
  std::vector<cv::Mat> through;
  for (const cv::Mat& frame : frames) through.push_back(stream.Through(frame));
  return through;
}

inline cv::Mat ThroughH264(const cv::Mat& frame, double crf) { return ClipThroughH264({frame}, crf)[0]; }

inline bool SameFrames(const std::vector<cv::Mat>& a, const std::vector<cv::Mat>& b) {
  return std::ranges::equal(a, b, SameBits);
}

// Calls f(colour) for grey and RGB from black to white.
template <class F>
void ForEachColour(const F& f) {
  for (int v = 0; v <= 255; v += 15) f(cv::Mat(48, 64, CV_8UC1, cv::Scalar(v)));
  for (int r = 0; r <= 255; r += 85)
    for (int g = 0; g <= 255; g += 85)
      for (int b = 0; b <= 255; b += 85) f(cv::Mat(48, 64, CV_8UC3, cv::Scalar(r, g, b)));
}

}  // namespace shimmer::dataset
