#include "sim/draw.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace shimmer::sim {
namespace {

constexpr int kDraws = 20000;

TEST(Draw, IsAFunctionOfSeedClipAndPath) {
  EXPECT_EQ(DrawUnit({0, 0}, "a"), DrawUnit({0, 0}, "a"));
  std::set<double> seen;
  for (uint64_t seed : {0, 1})
    for (uint64_t clip : {0, 1})
      for (const char* path : {"a", "b"}) seen.insert(DrawUnit({seed, clip}, path));
  EXPECT_EQ(seen.size(), 8u);
}

// Bits that must never change: a clip of today is a clip of tomorrow, on any machine.
TEST(Draw, HasTheseBitsForEver) {
  EXPECT_EQ(DrawUnit({0, 0}, "tilt.strength_px"), 0.27443257878297378);
  EXPECT_EQ(DrawLogUniform({0, 0}, "x", 1, 100), 5.7148673476772611);
  EXPECT_EQ(DrawNormal({0, 0}, "x", 1, 2, -5, 5), 0.34016441523710039);
}

TEST(Draw, UniformCoversItsRange) {
  double low = 1e9, high = -1e9, sum = 0;
  for (uint64_t clip = 0; clip < kDraws; ++clip) {
    const double v = DrawUniform({0, clip}, "u", -3, 5);
    low = std::min(low, v), high = std::max(high, v), sum += v;
  }
  EXPECT_GE(low, -3);
  EXPECT_LE(high, 5);
  EXPECT_LT(low, -2.99);
  EXPECT_GT(high, 4.99);
  EXPECT_NEAR(sum / kDraws, 1, 0.06);  // standard error 8 / sqrt(12 * 20000) = 0.016
  EXPECT_EQ(DrawUniform({0, 0}, "u", 2, 2), 2);
}

TEST(Draw, LogUniformHasEqualSharesOfEveryDecade) {
  int decades[3] = {};
  for (uint64_t clip = 0; clip < kDraws; ++clip) {
    const double v = DrawLogUniform({0, clip}, "l", 0.1, 100);
    ASSERT_GE(v, 0.1);
    ASSERT_LE(v, 100);
    ++decades[v < 1 ? 0 : v < 10 ? 1 : 2];
  }
  for (int count : decades) EXPECT_NEAR(count, kDraws / 3.0, 270);  // 4 standard errors
}

TEST(Draw, NormalIsCutNotClamped) {
  double sum = 0, sum2 = 0;
  int at_the_ends = 0;
  for (uint64_t clip = 0; clip < kDraws; ++clip) {
    const double v = DrawNormal({0, clip}, "n", 2, 3, -100, 100);
    sum += v, sum2 += v * v;
    const double cut = DrawNormal({0, clip}, "n", 0, 1, -1, 0.5);
    ASSERT_GE(cut, -1);
    ASSERT_LE(cut, 0.5);
    at_the_ends += cut == -1 || cut == 0.5;
  }
  EXPECT_NEAR(sum / kDraws, 2, 0.085);  // 4 standard errors
  EXPECT_NEAR(std::sqrt(sum2 / kDraws - 4), 3, 0.1);
  EXPECT_EQ(at_the_ends, 0);
  EXPECT_EQ(DrawNormal({0, 0}, "n", 2, 0, 0, 5), 2);
  const double far = DrawNormal({0, 0}, "n", 0, 1, 50, 60);  // nothing of the bell there: an end, not NaN
  EXPECT_GE(far, 50);
  EXPECT_LE(far, 60);
}

TEST(Draw, IntegersIncludeBothEnds) {
  int counts[4] = {};
  for (uint64_t clip = 0; clip < kDraws; ++clip) ++counts[DrawInteger({0, clip}, "i", -1, 2) + 1];
  for (int count : counts) EXPECT_NEAR(count, kDraws / 4.0, 250);
  EXPECT_EQ(DrawInteger({0, 0}, "i", 7, 7), 7);
}

TEST(Draw, IndicesFollowTheirWeights) {
  const std::vector<double> weights{1, 0, 3};
  int counts[3] = {};
  for (uint64_t clip = 0; clip < kDraws; ++clip) ++counts[DrawIndex({0, clip}, "w", weights)];
  EXPECT_EQ(counts[1], 0);
  EXPECT_NEAR(counts[2], 0.75 * kDraws, 250);
}

}  // namespace
}  // namespace shimmer::sim
