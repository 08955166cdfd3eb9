// The weights that mix a ladder's levels, for a row of sigmas.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "sim/level_ladder.h"

namespace shimmer::sim {

// Rows below are a multiple of so many floats, whatever the vector's length.
inline constexpr size_t kRowMultiple = 16;

// A ladder's mixtures as tables to look up, by the number of the mixture.
struct MixtureTables {
  explicit MixtureTables(const LevelLadder& ladder);

  int mixtures, levels;
  // t = sigma^2 scale + offset
  alignas(64) std::array<float, 16> scale, offset;
  alignas(64) std::array<std::array<float, 16>, 4> level;                  // [which of the four], as a float
  alignas(64) std::array<std::array<std::array<float, 16>, 4>, 4> weight;  // [which of the four][power]
};

// Bit k is set if level k has a weight for some sigma. Any size but 0.
uint32_t LevelsInUse(const MixtureTables& tables, std::span<const float> sigma_px);

// weights[k][i] = weight of level k at sigma_px[i], for the levels in use; others are left as they are.
// Size: a multiple of kRowMultiple, as of MixLevels.
void MixtureWeights(const MixtureTables& tables, uint32_t in_use, std::span<const float> sigma_px,
                    float* const* weights);

// out[i] = sum over levels in use of weights[k][i] values[k][i].
void MixLevels(uint32_t in_use, const float* const* weights, const float* const* values,
               std::span<float> out);

}  // namespace shimmer::sim
