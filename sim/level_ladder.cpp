#include "sim/level_ladder.h"

#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <stdexcept>

namespace shimmer::sim {
namespace {

constexpr size_t kLeastLevels = 4;  // for a mixture of four
constexpr int kCoarsestPx = 16;     // spacing of the coarsest grid

// A sigma of at least 1.4 grid steps.
int SpacingOf(double variance_px2) {
  int spacing = 1;
  while (spacing < kCoarsestPx && variance_px2 >= 8.0 * spacing * spacing) spacing *= 2;
  return spacing;
}

// Level 0 is the frame itself; the others double the variance from 1/4 on.
double VarianceOf(size_t level) { return level == 0 ? 0 : std::ldexp(0.25, static_cast<int>(level) - 1); }

std::vector<BlurLevel> MakeLevels(size_t count) {
  std::vector<BlurLevel> levels = {{.variance_px2 = 0, .spacing_px = 1, .kernel = {1}}};
  while (levels.size() < count) {
    const double variance = VarianceOf(levels.size());
    const int spacing = SpacingOf(variance);
    // Coarse levels take up where the one before ends; that one's spline is not part of what they take up.
    const BlurLevel& from = spacing > 1 && levels.back().spacing_px > 1 ? levels.back() : levels.front();
    const double done = from.variance_px2 - SplineVariance(from.spacing_px),
                 wanted = variance - SplineVariance(spacing);
    if (spacing == 1 && LevelKernel(std::sqrt(wanted - done)).size() > kMostFineTaps)
      throw std::logic_error("a fine level's kernel is too long");
    levels.push_back({variance, spacing, LevelKernel(std::sqrt(wanted - done) / from.spacing_px)});
  }
  return levels;
}

// Levels up to the first that is wide enough; and one more unless sigma stays near the level before it, for
// mixtures are better with levels on both sides.
size_t LevelCount(double max_sigma_px) {
  size_t count = kLeastLevels;
  while (VarianceOf(count - 1) < max_sigma_px * max_sigma_px / 0.6) ++count;
  return count;
}

// How far the light of a pixel comes from: as far as the coarsest level's Gaussian reaches (what its kernels,
// one after the other, may carry beyond that is less than 1e-6), and from whole points of its grid, four for
// the spline.
int Margin(const BlurLevel& coarsest) {
  constexpr double kReachSigmas = 5;
  return static_cast<int>(std::ceil(kReachSigmas * std::sqrt(coarsest.variance_px2))) +
         4 * coarsest.spacing_px;
}

}  // namespace

LevelLadder::LevelLadder(size_t levels)
    : levels_(MakeLevels(levels)), mixtures_(MakeMixtures(levels_)), margin_px_(Margin(levels_.back())) {}

const LevelLadder& LevelLadder::For(double max_sigma_px) {
  static std::array<std::once_flag, kMostLevels + 1> made;
  static std::array<std::unique_ptr<const LevelLadder>, kMostLevels + 1> ladders;
  const size_t count = LevelCount(max_sigma_px);
  std::call_once(made.at(count), [&] { ladders[count].reset(new LevelLadder(count)); });
  return *ladders[count];
}

}  // namespace shimmer::sim
