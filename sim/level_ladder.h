// The fast blur's levels: copies of the frame blurred by a ladder of sigmas, coarser ones on coarser grids,
// and for every sigma between them the mixture of a few copies that comes nearest to its Gaussian.
//
// A level need not be a Gaussian, only near one: mixtures are found by least squares over the spectrum of
// natural pictures (power 1 / frequency^2), with the levels' true transfer functions, short kernels, grids
// and splines included. How many levels there are to an octave is the grade's choice.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "sim/level_mixtures.h"

namespace shimmer::sim {

// How near to the exact Gaussian, from near and slow to rough and fast.
enum class LadderGrade { kFine, kStandard, kCoarse };
inline constexpr std::array<LadderGrade, 3> kLadderGrades = {LadderGrade::kFine, LadderGrade::kStandard,
                                                             LadderGrade::kCoarse};

// What a grade loses against each pixel's own Gaussian: RMS over a photograph in 1/255 of the range, at any
// sigma and at a clip's border too (tests/sim/ladder_blur_test.cpp).
struct LadderPromise {
  double levels;
  double levels_encoded;  // where the result is encoded as sRGB, which makes more of errors in the dark
};
LadderPromise PromiseOf(LadderGrade grade);

inline constexpr double kMostLadderSigmaPx = 32;
inline constexpr int kMostKernelRadius = 12;  // of any level

class LevelLadder {
 public:
  // The shortest ladder that holds sigmas up to max_sigma_px, in (0, kMostLadderSigmaPx]. Levels are made
  // once for all who ask for as many.
  static LevelLadder For(double max_sigma_px, LadderGrade grade);

  const std::vector<BlurLevel>& levels() const { return tables_->levels; }
  const std::vector<BlurMixture>& mixtures() const { return tables_->mixtures; }

  // Px around a pixel that its value is gathered from; what lies beyond is less than the promise, and taken
  // to be like the outermost pixels.
  int margin_px() const { return margin_px_; }

 private:
  struct Tables {
    std::vector<BlurLevel> levels;
    std::vector<BlurMixture> mixtures;
  };

  LevelLadder(std::shared_ptr<const Tables> tables, int margin_px)
      : tables_(std::move(tables)), margin_px_(margin_px) {}

  std::shared_ptr<const Tables> tables_;
  int margin_px_;
};

}  // namespace shimmer::sim
