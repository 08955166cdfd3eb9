// Reading a clean frame at exact, non-integer places. One resampling, whatever moves.
#pragma once

#include <opencv2/core.hpp>
#include <span>

#include "sim/scene.h"

namespace shimmer::sim {

// A margin of ceil(|d|) + kWarpReachPx px is always enough: an interpolation reads up to two px from
// floor(place), and its vectors of four one float more.
inline constexpr int kWarpReachPx = 3;

// out pixel i = frame at (first.x + i + dx[i], first.y + dy[i]), i < dx.size(); integer and fraction are kept
// apart. frame: CV_32FC1 or CV_32FC3; out: that many channels a pixel. Catmull-Rom for kBicubic (it over- and
// undershoots). The caller sees to it that every place lies kWarpReachPx within the frame.
void WarpRow(const cv::Mat& frame, cv::Point first, std::span<const float> dx, std::span<const float> dy,
             Interpolation interpolation, float* out);

// The double twin: one channel of frame at (x, y).
double WarpDouble(const cv::Mat& frame, double x, double y, int channel, Interpolation interpolation);

}  // namespace shimmer::sim
