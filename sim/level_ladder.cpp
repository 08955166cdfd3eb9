#include "sim/level_ladder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>

namespace shimmer::sim {
namespace {

constexpr int kCoarsestPx = 16;  // spacing of the coarsest grid

// A grade's sigmas and how finely its levels are computed; found by trying, on photographs.
struct Rule {
  std::vector<double> first_variances_px2;  // of levels 1, 2, ...; level 0 is the frame
  double next_variance_px2, ratio;          // and on from there
  double sigma_per_spacing;                 // a level's sigma is at least so many steps of its grid
  double kernel_sigmas;                     // kernels end here
  size_t mixed;                             // levels in a mixture
  double beyond;                            // widest level's variance at least, over that of the widest sigma
  double reach_sigmas;                      // px further than so many sigmas away count as the outermost ones
};

const Rule& RuleOf(LadderGrade grade) {
  static const Rule fine{{0.27, 0.6, 1.17, 2.25, 4.2}, 8, 1.78, 1.4, 3.5, 7, 1.6, 3.5},
      standard{{0.30, 0.71, 1.55, 3.5}, 7.4, 2, 1.3, 2.5, 6, 1.6, 3},
      coarse{{0.40, 1.4}, 3.7, 2.4, 1.2, 2.5, 5, 1.6, 2.5};
  return grade == LadderGrade::kFine ? fine : grade == LadderGrade::kStandard ? standard : coarse;
}

double VarianceOf(size_t level, const Rule& rule) {
  if (level == 0) return 0;
  const std::vector<double>& first = rule.first_variances_px2;
  if (level <= first.size()) return first[level - 1];
  double variance = rule.next_variance_px2;  // no std::pow, whose last bit depends on the CPU
  for (size_t k = first.size() + 1; k < level; ++k) variance *= rule.ratio;
  return variance;
}

// Levels up to the first that is wide enough for mixtures of the widest sigma to have a level on either side.
size_t LevelCount(double max_sigma_px, const Rule& rule) {
  size_t count = rule.mixed;
  while (VarianceOf(count - 1, rule) < rule.beyond * max_sigma_px * max_sigma_px) ++count;
  return count;
}

std::vector<BlurLevel> MakeLevels(size_t count, const Rule& rule) {
  std::vector<BlurLevel> levels = {{.variance_px2 = 0, .spacing_px = 1, .kernel = {1}}};
  double coarse_variance = 0;  // of the coarse levels' values so far, without a spline
  while (levels.size() < count) {
    const double variance = VarianceOf(levels.size(), rule), sigma = std::sqrt(variance);
    const int from_px = levels.back().spacing_px;
    const bool thin = from_px < kCoarsestPx && sigma >= rule.sigma_per_spacing * 2 * from_px;
    const int spacing = thin ? 2 * from_px : from_px;
    const double step = std::sqrt(variance - SplineVariance(spacing) - coarse_variance) / from_px;
    const int radius = std::max(1, static_cast<int>(std::lround(rule.kernel_sigmas * step)));
    if (radius > kMostKernelRadius) throw std::logic_error("a level's kernel is too long");
    levels.push_back({variance, spacing, LevelKernel(step, radius, thin)});
    if (spacing > 1) coarse_variance += KernelVariance(levels.back().kernel) * from_px * from_px;
  }
  return levels;
}

}  // namespace

LadderPromise PromiseOf(LadderGrade grade) {
  switch (grade) {
    case LadderGrade::kFine:
      return {.levels = 0.03, .levels_encoded = 0.1};
    case LadderGrade::kStandard:
      return {.levels = 0.085, .levels_encoded = 0.2};
    case LadderGrade::kCoarse:
      break;
  }
  return {.levels = 0.3, .levels_encoded = 1};
}

LevelLadder LevelLadder::For(double max_sigma_px, LadderGrade grade) {
  if (!(max_sigma_px > 0 && max_sigma_px <= kMostLadderSigmaPx))
    throw std::invalid_argument("max_sigma_px = " + std::to_string(max_sigma_px) + ", must be in (0, 32]");
  static std::mutex mutex;
  static std::map<std::pair<LadderGrade, size_t>, std::shared_ptr<const Tables>> made;
  const Rule& rule = RuleOf(grade);
  const size_t count = LevelCount(max_sigma_px, rule);

  const std::lock_guard lock(mutex);
  std::shared_ptr<const Tables>& tables = made[{grade, count}];
  if (!tables) {
    Tables fresh{.levels = MakeLevels(count, rule), .mixtures = {}};
    fresh.mixtures = MakeMixtures(fresh.levels, rule.mixed);
    tables = std::make_shared<const Tables>(std::move(fresh));
  }
  return {tables, static_cast<int>(std::ceil(rule.reach_sigmas * max_sigma_px))};
}

}  // namespace shimmer::sim
