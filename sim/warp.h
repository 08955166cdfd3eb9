// Reading a clean frame at exact, non-integer places. One resampling, whatever moves.
#pragma once

#include <opencv2/core.hpp>
#include <span>

#include "sim/scene.h"

namespace shimmer::sim {

// A margin of ceil(|d|) + kWarpReachPx px is always enough: what is read lies from one px before
// floor(place) to two after, and nothing beyond.
inline constexpr int kWarpReachPx = 2;

// What WarpRow reads: a colour frame (CV_8UC3, CV_16UC3, CV_32FC3) with a fourth sample a pixel that nobody
// reads, so that four neighbours are one vector; a grey one (CV_8UC1, CV_16UC1, CV_32FC1) as it is, not
// copied. Throws std::invalid_argument on any other type.
cv::Mat PrepareForWarp(const cv::Mat& clean);

// planes[c][i] = channel c of the frame at (first.x + i + dx[i], first.y + dy[i]), i < dx.size(); integer and
// fraction are kept apart. source: PrepareForWarp(frame); 8 bits mean v / 255, 16 bits v / 65535; planes:
// one, or three of a colour frame. Catmull-Rom for kBicubic (it over- and undershoots). Error against
// WarpDouble below 1e-6 of the range; whole shifts copy exactly; a grey frame gives the bits that three equal
// channels give, and every SIMD target the same bits. The caller sees to it that every place lies
// kWarpReachPx within the frame.
void WarpRow(const cv::Mat& source, cv::Point first, std::span<const float> dx, std::span<const float> dy,
             Interpolation interpolation, float* const* planes);

// The double twin: one channel of a frame, prepared or not, at (x, y).
double WarpDouble(const cv::Mat& frame, double x, double y, int channel, Interpolation interpolation);

}  // namespace shimmer::sim
