// How a ladder's levels (sim/level_ladder.h) are mixed for a sigma between them: the least squares behind the
// fast blur.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace shimmer::sim {

struct BlurLevel {
  double variance_px2;  // about sigma^2
  int spacing_px;       // of its grid: 1, 2, 4, ... px; values between are a cubic B-spline's
  // Half of a symmetric kernel, w[0], w[1], ...: at spacing 1 the whole blur, from the frame; else what the
  // level before it lacks (for the first coarse level: the frame), on that one's grid.
  std::vector<double> kernel;
};

// A stretch of sigma^2 in which neighbouring levels are mixed with weights that are cubics in t:
//   index 0: sigma^2 in [0, 1/16), t = 16 sigma^2;  index i > 0: sigma^2 in 2^(i - 5) [1, 2), t its place
//   there, in [0, 1).
struct BlurMixture {
  size_t first_level;
  std::vector<std::array<double, 4>> weight;  // [level - first_level][power of t]; they sum to 1 for every t
};

// The mixtures from sigma 0 up to the last level's sigma, each of `mixed` levels.
// levels: at least as many, as a LevelLadder makes them.
std::vector<BlurMixture> MakeMixtures(const std::vector<BlurLevel>& levels, size_t mixed);

// What a cubic B-spline on a grid of this spacing adds to the variance, in px^2.
double SplineVariance(int spacing_px);

// Half of a level's kernel: the sampled Gaussian out to radius, its sum brought to 1. thinned: only every
// second value is kept; then the taps at even places sum to 1/2, as do those at odd ones, so that no pixel's
// energy depends on where it lies.
std::vector<double> LevelKernel(double sigma, int radius, bool thinned);
double KernelVariance(const std::vector<double>& kernel);  // in its own steps^2

}  // namespace shimmer::sim
