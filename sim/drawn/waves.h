// Waves that the drawn scenes are made of: periodic functions of a phase in turns, and how they look through
// a pixel. Additions, multiplications, divisions and square roots only, so that a scene has the same bytes on
// every machine.
#pragma once

#include <algorithm>
#include <cmath>

namespace shimmer::sim {

double CosTurns(double turns);          // cos(2 pi turns), error < 1e-11; |turns| < 2^40
double AngleTurns(double x, double y);  // atan2(y, x) / (2 pi) in [-0.5, 0.5], error < 1e-10; 0 at (0, 0)

// 0 below low, 1 above high, smooth in between (cubic).
inline double SmoothStep(double low, double high, double value) {
  const double t = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Contrast of a pattern that repeats every period_px: none where the pixel grid could not tell it from
// another.
inline double ContrastOfPeriod(double period_px) { return SmoothStep(2, 4, period_px); }

// Mean over `width` turns around `turns` of the square wave that is 1 in [0, 0.5) and 0 in [0.5, 1): its
// exact area coverage of a pixel that is 1 / period_px turns wide.
double SquareCoverage(double turns, double width);

}  // namespace shimmer::sim
