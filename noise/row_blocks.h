// A row of lattice coordinates in blocks of 64 pixels: each block starts from the exact 64.64 coordinate, and
// the points in it from exact multiples of the step, so that rounding (2^-24 cell each) never adds up along a
// row. Blocks lie at multiples of 64 px, so that a pixel's bits do not depend on where its row, crop or tile
// begins.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "noise/fixed.h"

namespace shimmer::noise {

inline constexpr size_t kBlockPoints = 64;  // a multiple of every vector length

// The first pixel of a pixel's block.
inline constexpr int64_t BlockOf(int64_t x) { return x & -static_cast<int64_t>(kBlockPoints); }

// Coordinates of points are words: 8 bits of cell, one bit that means nothing, and 23 bits of fraction, which
// are the mantissa of 1 + fraction as a float. Block starts have the odd bit clear and offsets have it set,
// so that the sum of the two carries across it.
inline constexpr uint32_t kCarryBit = 0x800000, kFractionMask = 0x7fffff, kOneBits = 0x3f800000;

// From cells above 23 bits of fraction.
inline constexpr uint32_t SpreadWord(uint32_t cell_fraction) {
  return (cell_fraction + (cell_fraction & ~kFractionMask)) & ~kCarryBit;
}

// A step along a row, and where it leads within a block.
struct RowStep {
  Fixed step;
  alignas(64) std::array<uint32_t, kBlockPoints> offsets;  // of each point from its block's start

  explicit RowStep(Fixed step_px) : step(step_px) {
    // step i in 2^-23 cell: that of the step's whole ones, and that of the rest, which fits into 64 bits
    constexpr int kRestBits = 41;
    const auto whole = static_cast<uint32_t>(step.bits() >> kRestBits);
    const uint64_t rest = static_cast<uint64_t>(step.bits()) & ((uint64_t{1} << kRestBits) - 1);
    for (uint32_t i = 0; i < kBlockPoints; ++i)
      offsets[i] =
          kCarryBit | SpreadWord(whole * i + static_cast<uint32_t>(
                                                 (rest * i + (uint64_t{1} << (kRestBits - 1))) >> kRestBits));
  }
};

inline constexpr uint32_t WordOf(Fixed coordinate) { return SpreadWord(coordinate.Cell9Fraction23()); }

}  // namespace shimmer::noise
