// A row of lattice coordinates in blocks of 64 pixels: each block starts from the exact 64.64 coordinate, and
// the points in it from exact multiples of the step, so that rounding (2^-25 cell each) never adds up along a
// row. Blocks lie at multiples of 64 px, so that a pixel's bits do not depend on where its row, crop or tile
// begins.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "noise/fixed.h"

namespace shimmer::noise {

inline constexpr size_t kBlockPoints = 64;  // a multiple of every vector length

// One lattice coordinate along a row of pixels.
struct RowCoordinate {
  Fixed at_pixel0, step;
  alignas(64) std::array<uint32_t, kBlockPoints> offsets;  // of each point from its block's start: 8 bits of
                                                           // cell, 24 of fraction

  RowCoordinate(Fixed coordinate_at_pixel0, Fixed step_px) : at_pixel0(coordinate_at_pixel0), step(step_px) {
    for (size_t i = 0; i < kBlockPoints; ++i) offsets[i] = (step * static_cast<int64_t>(i)).Cell8Fraction24();
  }

  uint32_t BlockStart(int64_t pixel) const { return (at_pixel0 + step * pixel).Cell8Fraction24(); }
};

// Calls add(first pixel of a block, sums) for each block that meets pixels x0 .. x0 + out.size() - 1; add
// adds the block's values to its 64 sums, which are those of out, or a copy of them where out holds only part
// of the block.
template <class Add>
void AddBlocks(int64_t x0, std::span<float> out, const Add& add) {
  constexpr auto kPoints = static_cast<int64_t>(kBlockPoints);
  const int64_t end = x0 + static_cast<int64_t>(out.size());
  for (int64_t block = x0 & -kPoints; block < end; block += kPoints) {
    const int64_t first = std::max(block, x0), last = std::min(block + kPoints, end);
    if (last - first == kPoints) {
      add(block, out.data() + (block - x0));
    } else {
      float sums[kBlockPoints] = {};
      std::copy(out.data() + (first - x0), out.data() + (last - x0), sums + (first - block));
      add(block, sums);
      std::copy(sums + (first - block), sums + (last - block), out.data() + (first - x0));
    }
  }
}

inline constexpr uint32_t kFractionMask = 0xffffff;
inline constexpr float kFractionUnit = 0x1p-24f;

}  // namespace shimmer::noise
