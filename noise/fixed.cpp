#include "noise/fixed.h"

#include <cmath>

namespace shimmer::noise {

Fixed Fixed::FromDouble(double cells) {
  const double magnitude = std::abs(cells), whole = std::floor(magnitude);
  const auto fraction = static_cast<uint64_t>((magnitude - whole) * 0x1p64);
  const int128 bits = (int128{static_cast<int64_t>(whole)} << 64) + fraction;
  return Fixed(cells < 0 ? -bits : bits);
}

double Fixed::ToDouble() const {
  const int128 magnitude = bits_ < 0 ? -bits_ : bits_;
  const auto whole = static_cast<int64_t>(magnitude >> 64);
  const auto fraction = static_cast<uint64_t>(magnitude);
  const double cells = static_cast<double>(whole) + static_cast<double>(fraction) * 0x1p-64;
  return bits_ < 0 ? -cells : cells;
}

Fixed operator*(Fixed a, Fixed b) {
  using uint128 = unsigned __int128;
  const uint128 a_cells = static_cast<uint64_t>(a.bits_ >> 64), a_fraction = static_cast<uint64_t>(a.bits_);
  const uint128 b_cells = static_cast<uint64_t>(b.bits_ >> 64), b_fraction = static_cast<uint64_t>(b.bits_);
  const uint128 low = (a_fraction * b_fraction) >> 64;
  return Fixed(
      static_cast<int128>(((a_cells * b_cells) << 64) + a_cells * b_fraction + a_fraction * b_cells + low));
}

}  // namespace shimmer::noise
