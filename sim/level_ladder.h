// The fast blur's levels: copies of the frame blurred by a ladder of sigmas, coarser ones on coarser grids,
// and for every sigma between them the mixture of four copies that comes nearest to its Gaussian.
//
//   sigma_k^2 = 0, 1/4, 1/2, 1, 2, ... px^2: twice the variance from level to level.
//
// Mixtures are found by least squares over the spectrum of natural pictures (power 1 / frequency^2), with the
// levels' true transfer functions, grids and splines included; their weights are cubics in the place between
// two levels.
#pragma once

#include <array>
#include <vector>

namespace shimmer::sim {

// What mixing loses against each pixel's own Gaussian: RMS over a photograph, in 1/255 of the range, at any
// sigma (tests/sim/ladder_blur_test.cpp; the largest measured is 0.065).
inline constexpr double kLadderErrorLevels = 0.1;

struct BlurLevel {
  double variance_px2;  // sigma^2
  int spacing_px;       // of its grid: 1, 2, 4, ... px; values between are a cubic B-spline's
  std::vector<double>
      kernel;  // spacing 1: of the whole blur, from the frame; else from the level before it (level 0
               // for the first coarse one), on the grid of that level. Half: w[0], w[1], ...
};

// A stretch of sigma^2 in which four levels are mixed with weights that are cubics in t:
//   index 0: sigma^2 in [0, 1/16), t = 16 sigma^2;  index i > 0: sigma^2 in 2^(i - 5) [1, 2), t its place
//   there, in [0, 1).
struct BlurMixture {
  std::array<int, 4> level;  // numbers of the levels; at least two distinct from the others
  std::array<std::array<double, 4>, 4> weight;  // [which of the four][power of t]; they sum to 1 for every t
};

class LevelLadder {
 public:
  static constexpr int kMostMixtures = 15;  // sigma up to 32 px

  // The shortest ladder that holds sigmas up to max_sigma_px, in (0, 32].
  explicit LevelLadder(double max_sigma_px);

  const std::vector<BlurLevel>& levels() const { return levels_; }
  const std::vector<BlurMixture>& mixtures() const { return mixtures_; }

  // Px around a pixel that its value is gathered from.
  int margin_px() const { return margin_px_; }

  // Spacing of the coarsest grid. Grids start at the frame's first pixel.
  int coarsest_px() const { return levels_.back().spacing_px; }

 private:
  std::vector<BlurLevel> levels_;
  std::vector<BlurMixture> mixtures_;
  int margin_px_ = 0;
};

}  // namespace shimmer::sim
