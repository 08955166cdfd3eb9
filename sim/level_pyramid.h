// The coarse levels of a frame (sim/level_ladder.h): smoothed and thinned out, one after the other.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "sim/level_ladder.h"
#include "sim/planes.h"

namespace shimmer::sim {

// A coarse level: coefficients of a cubic B-spline, that of grid point (i, j) at pixel (i, j) spacing_px.
struct CoarseLevel {
  int spacing_px;
  Planes coefficients;  // of the frame's channels
};

// Element k belongs to level k of the ladder; empty for its fine levels. Beyond frame and grids their edges
// go on. Channels and rows go to oneTBB's threads.
std::vector<CoarseLevel> CoarseLevels(const Planes& frame, const LevelLadder& ladder);

}  // namespace shimmer::sim
