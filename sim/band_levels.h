// What the fast blur's inner loops (sim/ladder_blur.cpp) read and write.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/level_pyramid.h"
#include "sim/mixture_weights.h"
#include "sim/planes.h"

namespace shimmer::sim {

// Of a row at a time: long, so that the processor sees rows coming and fetches them ahead, yet all that a
// stretch needs stays in the second cache. A multiple of every spacing.
inline constexpr int kStretchPx = 2048;
inline constexpr int kBlockPx = 64;  // of a stretch: a level is computed for the blocks that ask for it
inline constexpr size_t kStretchBlocks = kStretchPx / kBlockPx;
inline constexpr size_t kMostLanes = 16;
inline constexpr int kSpacings = 4;  // of coarse levels: 2, 4, 8, 16 px

// Half of a fine level's symmetric kernel, and zeros; nothing for a coarse level.
struct FineKernel {
  int radius = 0;
  std::array<float, kMostKernelRadius + 1> weight{};
};

struct BandLevels {
  const Planes& frame;
  const MixtureTables& tables;
  const std::vector<FineKernel>& kernels;  // [level]
  int most_radius;                         // of them all
  const std::vector<CoarseLevel>& coarse;  // [level]
};

struct BandScratch {
  alignas(64) float sigma[kStretchPx];
  alignas(64) float place[kStretchPx];          // t in its mixture
  alignas(64) uint32_t mixture[kStretchPx];     // its number
  std::array<uint32_t, kStretchBlocks> levels;  // bit k: level k has a part in the block
  // Padded: rows a multiple of 4 KiB apart would be taken for one another when stored and loaded
  alignas(64) float sum[3][kStretchPx + 5 * kMostLanes];  // of the levels so far, [channel]
  // One level's rows, convolved or mixed down the columns but not yet along
  alignas(64) float down[3][kStretchPx + 2 * kMostLanes] = {};
};

// A cubic B-spline's weights for a pixel `phase` px after a grid point, phase < spacing: of the points one
// before, at, one and two after.
std::array<float, 4> SplineWeights(int phase, int spacing_px);

// The same for a grid's phases, and for pixels x, x + 1, ...: what repeats every 16 px.
struct SplinePhases {
  std::array<std::array<float, 4>, kMostLanes> down;  // [phase]
  alignas(64) float weight[4][kMostLanes];
  alignas(64) int32_t point[kMostLanes];  // grid points between those of pixel x and of this one
};
SplinePhases PhasesOf(int x, int spacing_px);

}  // namespace shimmer::sim
