// Lattice coordinates in 64.64 fixed point: a whole number of cells and a fraction of 2^-64 cell. Products
// with integer pixels and frames are exact, so that noise at frame 2^31 is as exact as at frame 0 (DESIGN
// section 3, "Numbers").
#pragma once

#include <cstdint>

namespace shimmer::noise {

__extension__ typedef __int128 int128;

// Both lattices repeat after 768 cells along an axis: Perlin's after 256, and the simplex lattice, whose
// skewed axes turn 768 cells into 1024 and 256, after 768.
inline constexpr int kPeriodCells = 768;

class Fixed {
 public:
  constexpr Fixed() = default;
  static Fixed FromDouble(double cells);  // |cells| < 2^62; exact to 2^-64
  static constexpr Fixed FromBits(int128 bits) { return Fixed(bits); }

  constexpr int128 bits() const { return bits_; }  // cells * 2^64
  double ToDouble() const;                         // nearest

  friend constexpr Fixed operator+(Fixed a, Fixed b) { return Fixed(a.bits_ + b.bits_); }
  friend constexpr Fixed operator*(Fixed a, int64_t n) { return Fixed(a.bits_ * n); }  // exact if it fits
  friend Fixed operator*(Fixed a, Fixed b);  // both >= 0, product < 2^63; truncated to 2^-64
  friend constexpr bool operator==(Fixed, Fixed) = default;

  constexpr Fixed Third() const { return Fixed(bits_ / 3); }

  // The same place on the lattice, in [0, kPeriodCells).
  constexpr Fixed Reduced() const {
    const auto cells = static_cast<int64_t>(bits_ >> 64) % kPeriodCells;
    return Fixed((int128{cells < 0 ? cells + kPeriodCells : cells} << 64) + static_cast<uint64_t>(bits_));
  }

  // Cell modulo 512 in the 9 high bits, 23 bits of fraction below it; rounded to nearest.
  constexpr uint32_t Cell9Fraction23() const {
    return static_cast<uint32_t>((bits_ + (int128{1} << 40)) >> 41);
  }

  // Cell modulo 256 in the high byte, 24 bits of fraction below it; rounded to nearest.
  constexpr uint32_t Cell8Fraction24() const {
    return static_cast<uint32_t>((bits_ + (int128{1} << 39)) >> 40);
  }

 private:
  explicit constexpr Fixed(int128 bits) : bits_(bits) {}
  int128 bits_ = 0;
};

}  // namespace shimmer::noise
