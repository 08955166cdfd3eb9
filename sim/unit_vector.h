#pragma once

#include <cmath>
#include <opencv2/core/types.hpp>

#include "noise/portable_math.h"

namespace shimmer::sim {

// (cos, sin) of 2 pi turns, the same bits on every machine. On screen, where y grows downwards, clockwise
// from the right.
inline cv::Point2d UnitVector(double turns) {
  constexpr double kTurn = 6.283185307179586;
  const auto cosine = [](double any) { return noise::Cos(kTurn * (any - std::floor(any))); };
  return {cosine(turns), cosine(turns - 0.25)};
}

}  // namespace shimmer::sim
