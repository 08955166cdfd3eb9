// The fast blur's levels: copies of the frame blurred by a ladder of sigmas, coarser ones on coarser grids,
// and for every sigma between them the mixture of four copies that comes nearest to its Gaussian.
//
//   sigma_k^2 = 0, 1/4, 1/2, 1, 2, ... px^2: twice the variance from level to level.
//
// Mixtures are found by least squares over the spectrum of natural pictures (power 1 / frequency^2), with the
// levels' true transfer functions, grids and splines included; their weights are cubics in the place between
// two levels.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/level_mixtures.h"

namespace shimmer::sim {

// What mixing loses against each pixel's own Gaussian: RMS over a photograph, in 1/255 of the range, at any
// sigma (tests/sim/ladder_blur_test.cpp; the largest measured is 0.071).
inline constexpr double kLadderErrorLevels = 0.1;
// The same where the result is encoded as sRGB afterwards, which makes more of errors in the dark: the
// largest measured is 0.19, on a photograph darkened to its square.
inline constexpr double kLadderErrorLevelsEncoded = 0.3;

inline constexpr size_t kMostLevels = 15;    // of a ladder to 32 px
inline constexpr size_t kMostFineTaps = 16;  // of half a kernel of a level on the frame's own grid

class LevelLadder {
 public:
  // The shortest ladder that holds sigmas up to max_sigma_px, in (0, 32]. Made once for all who ask for it.
  static const LevelLadder& For(double max_sigma_px);

  const std::vector<BlurLevel>& levels() const { return levels_; }
  const std::vector<BlurMixture>& mixtures() const { return mixtures_; }

  // Px around a pixel that its value is gathered from.
  int margin_px() const { return margin_px_; }

 private:
  explicit LevelLadder(size_t levels);

  std::vector<BlurLevel> levels_;
  std::vector<BlurMixture> mixtures_;
  int margin_px_ = 0;
};

}  // namespace shimmer::sim
