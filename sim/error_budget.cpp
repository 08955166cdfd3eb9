#include "sim/error_budget.h"

#include <algorithm>
#include <cmath>

#include "noise/portable_math.h"
#include "sim/sigma_map.h"

namespace shimmer::sim {
namespace {

constexpr double kMostLevels = 40, kLevelsTimesSigma = 20;
constexpr double kKink_px = kLevelsTimesSigma / kMostLevels;

// Integral of min(40, 20 / sigma)^2 from 0.
double SquaresUpTo(double sigma_px) {
  const double flat = kMostLevels * kMostLevels * std::min(sigma_px, kKink_px);
  if (sigma_px <= kKink_px) return flat;
  return flat + kLevelsTimesSigma * kLevelsTimesSigma * (1 / kKink_px - 1 / sigma_px);
}

// RMS over sigmas spread evenly from the least to the most.
double EvenLevelsPerSigmaPx(const BlurParams& blur) {
  const double range_px = blur.max_sigma_px - blur.min_sigma_px;
  if (range_px < 1e-3) return LevelsPerSigmaPx(blur.min_sigma_px);
  return std::sqrt((SquaresUpTo(blur.max_sigma_px) - SquaresUpTo(blur.min_sigma_px)) / range_px);
}

bool SeesTheWholeMap(double base_frequency, cv::Size size) {
  return base_frequency * std::min(size.width, size.height) >= 3;
}

// The largest levels_per_px(sigma) slope(u) over places u of a map, whose own part of sigma is share(u).
template <class Share, class Slope>
double Worst(const BlurParams& blur, double part_px, const Share& share, const Slope& slope) {
  double worst = 0;
  for (int i = -400; i <= 400; ++i) {
    const double u = i * 0.01;
    worst = std::max(worst, LevelsPerSigmaPx(blur.min_sigma_px + part_px * share(u)) * slope(u));
  }
  return part_px * worst;
}

}  // namespace

double LevelsPerSigmaPx(double sigma_px) {
  return std::min(kMostLevels, kLevelsTimesSigma / std::max(sigma_px, 1e-9));
}

double LevelsPerNoise(const BlurParams& blur, cv::Size size) {
  constexpr double kSteepest = 0.3990;  // 1 / sqrt(2 pi), of Phi at 0
  const double part_px = (blur.max_sigma_px - blur.min_sigma_px) * (1 - blur.tilt_weight);
  const double levels = SeesTheWholeMap(blur.base_frequency, size)
                            ? EvenLevelsPerSigmaPx(blur) * part_px * kSteepest
                            : Worst(blur, part_px, noise::NormalCdf,
                                    [](double u) { return kSteepest * noise::Exp(-0.5 * u * u); });
  return levels / kPerlinRms;
}

double LevelsPerTiltPx(const Scene& scene, cv::Size size) {
  constexpr double kSteepest = 0.6066;  // 1 / sqrt(e), of 1 - exp(-r^2 / 2) at r = 1
  const BlurParams& blur = scene.blur;
  if (scene.tilt.strength_px <= 0) return 0;
  const double part_px = (blur.max_sigma_px - blur.min_sigma_px) * blur.tilt_weight;
  const double levels = SeesTheWholeMap(scene.tilt.base_frequency, size)
                            ? EvenLevelsPerSigmaPx(blur) * part_px * kSteepest
                            : Worst(
                                  blur, part_px, [](double r) { return 1 - noise::Exp(-0.5 * r * r); },
                                  [](double r) { return std::abs(r) * noise::Exp(-0.5 * r * r); });
  return levels / (kTiltRmsOfStrength * scene.tilt.strength_px);
}

SigmaBudget ShareLevels(const Scene& scene, const BlurPlan& plan, cv::Size size, double levels) {
  const double each = plan.noise && plan.tilt ? levels * std::sqrt(0.5) : levels;
  const double per_noise = LevelsPerNoise(scene.blur, size), per_tilt = LevelsPerTiltPx(scene, size);
  SigmaBudget budget;
  if (plan.noise && per_noise > 0) budget.noise = each / per_noise;
  if (plan.tilt && per_tilt > 0) budget.tilt_px = each / per_tilt;
  return budget;
}

}  // namespace shimmer::sim
