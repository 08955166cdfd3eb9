// A ladder's mixtures as tables to look up, by the number of the mixture.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "sim/level_ladder.h"

namespace shimmer::sim {

inline constexpr size_t kMostLevels = 20;
inline constexpr size_t kMostMixtures = 16;

struct MixtureTables {
  explicit MixtureTables(const LevelLadder& ladder);

  int mixtures;
  // t = sigma^2 scale + offset
  alignas(64) std::array<float, kMostMixtures> scale, offset;
  // [level][power of t]; 0 where a level has no part in a mixture
  alignas(64) std::array<std::array<std::array<float, kMostMixtures>, 4>, kMostLevels> weight;
  // A word's bits, to be looked up like the others: bit k is set if level k has a part in the mixture
  alignas(64) std::array<float, kMostMixtures> levels;
};

// The mixture of sigma^2 is its binary exponent less this one (biased, as in the float), and 0 for all below.
inline constexpr int kFirstExponent = 127 - 5;

}  // namespace shimmer::sim
