#include "noise/portable_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace shimmer::noise {
namespace {

constexpr double kLast = std::numeric_limits<double>::epsilon();

TEST(Exp, EqualsLibm) {
  for (double x = -700; x < 709; x += 0.37) EXPECT_NEAR(Exp(x) / std::exp(x), 1, 2 * kLast) << x;
  EXPECT_EQ(Exp(0), 1);
  EXPECT_EQ(Exp(-1e9), 0);
  EXPECT_TRUE(std::isinf(Exp(1e9)));
}

TEST(Log, EqualsLibm) {
  for (double x = 1e-300; x < 1e300; x *= 1.7)
    EXPECT_NEAR(Log(x), std::log(x), 2 * kLast * std::max(1.0, std::abs(std::log(x)))) << x;
  EXPECT_EQ(Log(1), 0);
}

TEST(Cos, EqualsLibm) {
  for (double x = -900; x < 900; x += 0.0137)
    EXPECT_NEAR(Cos(x), std::cos(x), 2 * kLast * std::max(1.0, std::abs(x))) << x;
  EXPECT_EQ(Cos(0), 1);
}

TEST(NormalCdf, EqualsErfc) {
  for (double x = -9; x <= 9; x += 0.01)
    EXPECT_NEAR(NormalCdf(x), 0.5 * std::erfc(-x / std::sqrt(2.0)), 1e-15) << x;
}

TEST(NormalQuantile, IsTheInverse) {
  for (double p : {1e-12, 1e-3, 0.1, 0.5, 0.9, 0.999})
    EXPECT_NEAR(NormalCdf(NormalQuantile(p)), p, 1e-15 + 1e-13 * p) << p;
}

}  // namespace
}  // namespace shimmer::noise
