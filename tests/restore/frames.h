// Frames of known samples.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "restore/levels.h"

namespace shimmer::restore {

// The same number of levels in all samples.
inline cv::Mat Flat(cv::Size size, int type, double level) {
  return cv::Mat(size, type, cv::Scalar::all(level / 255 * WhiteOf(CV_MAT_DEPTH(type))));
}

// Each sample random in [0, white].
inline cv::Mat Noise(cv::Size size, int type, uint32_t seed) {
  cv::Mat noise(size, CV_MAKETYPE(CV_64F, CV_MAT_CN(type))), frame;
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> sample(0, WhiteOf(CV_MAT_DEPTH(type)));
  for (int y = 0; y < size.height; ++y)
    for (int i = 0; i < size.width * noise.channels(); ++i) noise.ptr<double>(y)[i] = sample(generator);
  noise.convertTo(frame, CV_MAT_DEPTH(type));
  return frame;
}

// Blots of some 8 px, CV_8UC1: no part of it looks like another.
inline cv::Mat Blots(cv::Size size, uint32_t seed) {
  cv::Mat blots;
  cv::resize(Noise(size / 8, CV_8UC1, seed), blots, size, 0, 0, cv::INTER_CUBIC);
  return blots;
}

// A sample in levels.
inline double LevelAt(const cv::Mat& frame, int x, int y, int c) {
  const int i = x * frame.channels() + c;
  const double sample = frame.depth() == CV_8U    ? frame.ptr<uint8_t>(y)[i]
                        : frame.depth() == CV_16U ? frame.ptr<uint16_t>(y)[i]
                                                  : frame.ptr<float>(y)[i];
  return sample / WhiteOf(frame.depth()) * 255;
}

}  // namespace shimmer::restore
