// The lattices that noise is drawn on: a permutation of the bytes that hashes cells to gradients, and the
// gradients.
#pragma once

#include <array>
#include <cstdint>

#include "noise/hash.h"

namespace shimmer::noise {

using Permutation = std::array<uint8_t, 256>;

const Permutation& ClassicPermutation();  // Perlin's own table, as in the noise library that the paper names
Permutation ShuffledPermutation(HashStream& stream);  // Fisher-Yates

// The cube's twelve edges, and four of them again to make sixteen: simplex noise takes hash mod 12, Perlin
// hash & 15.
inline constexpr float kGradients[16][3] = {{1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0},  // xy
                                            {1, 0, 1},  {-1, 0, 1},  {1, 0, -1}, {-1, 0, -1},  // xz
                                            {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1},  // yz
                                            {1, 0, -1}, {-1, 0, -1}, {0, -1, 1}, {0, 1, 1}};

}  // namespace shimmer::noise
