// Frames in one unit, whatever their samples are: levels, in which black is 0 and white is 255.
#pragma once

#include <algorithm>
#include <opencv2/core.hpp>
#include <string>

namespace shimmer::restore {

// 255, 65535 or 1: white in samples of CV_8U, CV_16U or CV_32F.
double WhiteOf(int depth);

std::string SizeText(cv::Size size);  // "1920x1080"

// A frame: CV_8U (white 255), CV_16U (white 65535) or CV_32F (white 1), of 1 channel (grey) or 3 (RGB).
// What takes frames throws std::invalid_argument with `name` for any other, and for an empty one.
void RequireFrame(const cv::Mat& frame, const char* name);

// The same for two of one size in px; their types may differ. Returns the channels in which they are
// compared: 1 if both are grey.
int RequireFramePair(const cv::Mat& a, const cv::Mat& b);

// Rows of a frame, CV_64F of so many channels; a grey frame has three equal ones where 3 are asked for.
// Floats outside of [0, 1] stay outside of [0, 255]. Throws std::invalid_argument for a sample that is not
// finite.
cv::Mat Levels(const cv::Mat& frame, cv::Range rows, int channels);

// Y of YCbCr as ITU-R BT.601 has it in studio range, unrounded, CV_64FC1: 16 + (65.481 R + 128.553 G +
// 24.966 B) / 255, in [16, 235]. Of one channel: that channel, unchanged. BasicSR's and Restormer's
// evaluation does both.
cv::Mat LumaLevels(const cv::Mat& frame, cv::Range rows, int channels);

// The greatest of each px's channels; of one channel: the frame itself.
cv::Mat MostOfChannels(const cv::Mat& frame);

// Rows that are worked on at a time: what is computed of a frame in double fits into the caches, and sums are
// made in this order, whatever the threads.
inline constexpr int kRowsAtOnce = 32;

// Calls f(rows) for [0, rows), kRowsAtOnce at a time, in order.
template <class F>
void ForRows(int rows, const F& f) {
  for (int y = 0; y < rows; y += kRowsAtOnce) f(cv::Range(y, std::min(y + kRowsAtOnce, rows)));
}

}  // namespace shimmer::restore
