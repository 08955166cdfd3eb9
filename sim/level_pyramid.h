// The coarse levels of a frame (sim/level_ladder.h): smoothed and thinned out, one after the other.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "sim/level_ladder.h"

namespace shimmer::sim {

// A coarse level: coefficients of a cubic B-spline, that of grid point (i, j) at pixel (i, j) spacing_px.
struct CoarsePlane {
  int spacing_px;
  cv::Mat coefficients;  // CV_32FC1
};

// plane: CV_32FC1, one channel of a frame. Element k belongs to level k of the ladder; empty for its fine
// levels. Beyond the plane its edge pixels go on: values within the ladder's margin of the edge are not those
// of the frame.
std::vector<CoarsePlane> CoarseLevels(const cv::Mat& plane, const LevelLadder& ladder);

// Writes the values of pixels x0 .. x0 + out.size() - 1 of row y, all at least 3 spacing_px within the grid.
// x0 and out.size() are multiples of spacing_px. scratch keeps its memory from call to call.
void CoarseRow(const CoarsePlane& plane, int y, int x0, std::span<float> out, std::vector<float>& scratch);

}  // namespace shimmer::sim
