#include "sim/mixture_weights.h"

#include <bit>
#include <cmath>
#include <stdexcept>

namespace shimmer::sim {
MixtureTables::MixtureTables(const LevelLadder& ladder)
    : mixtures(static_cast<int>(ladder.mixtures().size())), scale{}, offset{}, weight{}, levels{} {
  if (ladder.mixtures().size() > kMostMixtures || ladder.levels().size() > kMostLevels)
    throw std::logic_error("a ladder is too long for its tables");
  for (size_t i = 0; i < ladder.mixtures().size(); ++i) {
    const BlurMixture& mixture = ladder.mixtures()[i];
    scale[i] = i == 0 ? 16.0f : std::ldexp(1.0f, 5 - static_cast<int>(i));
    offset[i] = i == 0 ? 0.0f : -1.0f;
    uint32_t taking_part = 0;
    for (size_t r = 0; r < mixture.weight.size(); ++r) {
      const size_t level = mixture.first_level + r;
      taking_part |= 1u << level;
      for (size_t power = 0; power < 4; ++power)
        weight[level][power][i] = static_cast<float>(mixture.weight[r][power]);
    }
    levels[i] = std::bit_cast<float>(taking_part);
  }
}

}  // namespace shimmer::sim
