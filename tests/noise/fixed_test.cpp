#include "noise/fixed.h"

#include <gtest/gtest.h>

#include <cmath>

#include "noise/hash.h"

namespace shimmer::noise {
namespace {

TEST(Fixed, HoldsDoublesToItsLastBit) {
  for (double v : {0.0, 1.0, -1.0, 0.015, 1e-6, -1e-6, 767.999999, 0x1p40 + 0.5})
    EXPECT_NEAR(Fixed::FromDouble(v).ToDouble(), v, 0x1p-64);
  EXPECT_EQ(Fixed::FromDouble(-0.25) + Fixed::FromDouble(0.25), Fixed());
}

// Against long double, whose 64-bit mantissa holds these products to 2^-50.
TEST(Fixed, MultipliesLikeRealNumbers) {
  HashStream stream(1);
  for (int i = 0; i < 1000; ++i) {
    const double a = UnitFromBits(stream.Next()) * 100, b = UnitFromBits(stream.Next()) * 100;
    EXPECT_NEAR((Fixed::FromDouble(a) * Fixed::FromDouble(b)).ToDouble(),
                static_cast<double>(static_cast<long double>(a) * b), 1e-11);
  }
}

// The place of frame 2^31 reduced modulo the period, against integer arithmetic: a step of m / 2^32 cells
// times n is m n / 2^32, whose remainder by 768 follows from 64-bit integers.
TEST(Fixed, ReducesFarPlacesExactly) {
  HashStream stream(2);
  for (int i = 0; i < 1000; ++i) {
    const auto m = static_cast<int64_t>(stream.Below(uint64_t{1} << 31));
    const auto n = static_cast<int64_t>(stream.Below(uint64_t{1} << 31)) - (int64_t{1} << 30);
    const int64_t period = int64_t{768} << 32;
    const int64_t rest = ((m * n) % period + period) % period;
    const Fixed step = Fixed::FromDouble(static_cast<double>(m) * 0x1p-32);
    EXPECT_EQ((step * n).Reduced().ToDouble(), static_cast<double>(rest) * 0x1p-32);
  }
}

TEST(Fixed, SplitsIntoCellAndFraction) {
  EXPECT_EQ(Fixed::FromDouble(3.5).Cell8Fraction24(), (3u << 24) | (1u << 23));
  EXPECT_EQ(Fixed::FromDouble(259.25).Cell8Fraction24(), (3u << 24) | (1u << 22));
  EXPECT_EQ(Fixed::FromDouble(-0.5).Cell8Fraction24(), (255u << 24) | (1u << 23));
  EXPECT_EQ(Fixed::FromDouble(-0.5).Cell9Fraction23(), (511u << 23) | (1u << 22));
  EXPECT_EQ(Fixed::FromDouble(255.9999999999).Cell8Fraction24(), 0u);  // rounds up into the next cell
}

}  // namespace
}  // namespace shimmer::noise
