// What interpolating noise costs, in units of the noise, for the worst lattice at the worst place: tables by
// wavelength per step (the noise's cell over the distance of the points that it is taken at), found by search
// (tests/noise/worst_error.h: over places by climbing, over gradients exactly), with a margin of 3 % (max)
// and 10 % (RMS). Wavelengths below two steps are not interpolated: the error is then what a dropped octave's
// would be, and more.
#pragma once

#include "noise/noise_kind.h"

namespace shimmer::noise {

struct NoiseError {
  double max = 0;  // at any place, for any table
  double rms = 0;  // over tables, at the place in the cell where it is largest; of a grid, over a cell, for
                   // the worst place of the grid and of the frame in it
};

inline constexpr double kFewestStepsPerCell = 2;

// Of cubic B-splines over filtered points, evaluated at spacing_px places a step along each axis. Kernel 0.6
// jumps by up to 0.0064 where simplices meet, which no grid follows: its max error stays above 0.006 (spacing
// 2: pixels lie at or midway between points), 0.009 (4) or 0.011.
NoiseError GridError(NoiseKind kind, int spacing_px, double steps_per_cell);

// Of a cubic through four key frames, frames a step of the time axis.
NoiseError KeyFrameError(NoiseKind kind, double steps_per_cell);
inline constexpr double kKeyFrameGain =
    1.25;  // of errors that the key frames hold: the cubic's sum of |weights|

// Of leaving noise out: its size.
NoiseError SizeOf(NoiseKind kind);

}  // namespace shimmer::noise
