// How the error that blurring may make is shared: between the blur itself, and the errors of sigma that its
// map makes.
//
//   levels^2 = (the ladder's promise)^2 + (levels per px of sigma)^2 (sigma error)^2
//   sigma error^2 = (Perlin's share)^2 + (the tilt's share)^2        all RMS over a frame
#pragma once

#include <limits>

#include "sim/plan.h"

namespace shimmer::sim {

// What a natural picture changes by, in 1/255 for a px of sigma: at most min(40, 20 / sigma), RMS over the
// sharpest of eight photographs.
double LevelsPerSigmaPx(double sigma_px);

// RMS errors that a clip's fields may have, so that the sigma map stays within its share of the levels.
struct SigmaBudget {
  double noise = std::numeric_limits<double>::infinity();    // of m
  double tilt_px = std::numeric_limits<double>::infinity();  // of each axis of the tilt
};

// What an error of m, or of the tilt, makes of a picture: levels for a unit of it. Over a frame that sees the
// whole map (at least three cells of its slowest octave along each axis) the RMS over sigmas spread evenly,
// with the map's steepest slope; else at the worst sigma that there may be everywhere.
double LevelsPerNoise(const BlurParams& blur, cv::Size size);
double LevelsPerTiltPx(const Scene& scene, cv::Size size);

SigmaBudget ShareLevels(const Scene& scene, const BlurPlan& plan, cv::Size size, double levels);

}  // namespace shimmer::sim
