#include "sim/band_levels.h"

namespace shimmer::sim {

std::array<float, 4> SplineWeights(int phase, int spacing_px) {
  const float t = static_cast<float>(phase) / static_cast<float>(spacing_px), s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
          t * t * t / 6};
}

SplinePhases PhasesOf(int x, int spacing_px) {
  SplinePhases phases;
  for (int phase = 0; phase < spacing_px; ++phase)
    phases.down[static_cast<size_t>(phase)] = SplineWeights(phase, spacing_px);
  for (size_t i = 0; i < kMostLanes; ++i) {
    const int from_point = x % spacing_px + static_cast<int>(i);
    const std::array<float, 4> weights = SplineWeights(from_point % spacing_px, spacing_px);
    for (size_t k = 0; k < 4; ++k) phases.weight[k][i] = weights[k];
    phases.point[i] = from_point / spacing_px;
  }
  return phases;
}

}  // namespace shimmer::sim
