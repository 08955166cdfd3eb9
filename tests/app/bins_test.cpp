// Bins of histograms.
#include "sim/app/bins.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace shimmer::app {
namespace {

using cli::AxisKind;
using Numbers = std::vector<double>;

// Side by side, finite, some 15 to 30 unless there is less to tell apart, and every number is in one that
// holds it.
void ExpectBinsHold(const Numbers& sorted, AxisKind kind) {
  const std::vector<Bin> bins = PutIntoBins(sorted, kind);
  ASSERT_FALSE(bins.empty());
  EXPECT_LE(bins.size(), 32u);
  int64_t count = 0;
  for (size_t i = 0; i < bins.size(); ++i) {
    const Bin& bin = bins[i];
    ASSERT_TRUE(std::isfinite(bin.low) && std::isfinite(bin.high)) << bin.low << " " << bin.high;
    ASSERT_LT(bin.low, bin.high);
    if (i > 0) {
      EXPECT_EQ(bin.low, bins[i - 1].high);
    }
    EXPECT_FALSE(bin.text.empty());
    count += bin.count;
    const bool last = i + 1 == bins.size();
    // A number that is an edge but for rounding may lie on its other side, at the very ends.
    const double slack = 1e-5 * (bin.high - bin.low);
    EXPECT_EQ(bin.count,
              std::ranges::count_if(sorted,
                                    [&](double value) {
                                      return (value >= bin.low || (i == 0 && value >= bin.low - slack)) &&
                                             (value < bin.high || (last && value <= bin.high + slack));
                                    }))
        << bin.text;
  }
  EXPECT_EQ(count, std::ssize(sorted));
  EXPECT_GT(bins.front().count, 0);  // no bins beyond the numbers
  EXPECT_GT(bins.back().count, 0);
}

TEST(Bins, HoldEveryNumberOnce) {
  std::mt19937 generator(1);
  for (int round = 0; round < 300; ++round) {
    const double scale = std::pow(10, std::uniform_real_distribution<>(-7, 7)(generator));
    const double start = std::uniform_real_distribution<>(-3, 3)(generator) * scale;
    std::uniform_real_distribution<> number(start, start + scale);
    Numbers sorted(1 + generator() % 200);
    for (double& value : sorted) value = number(generator);
    std::ranges::sort(sorted);
    ExpectBinsHold(sorted, AxisKind::kLinear);
    if (sorted.size() > 1 && sorted.front() > 0) ExpectBinsHold(sorted, AxisKind::kLogarithmic);
    for (double& value : sorted) value = std::round(value);
    ExpectBinsHold(sorted, AxisKind::kWhole);
  }
}

TEST(Bins, AreEnoughForManyNumbersAndRound) {
  Numbers sorted;
  for (int i = 0; i <= 1000; ++i) sorted.push_back(2 + 6 * i / 1000.0);
  const std::vector<Bin> bins = PutIntoBins(sorted, AxisKind::kLinear);
  EXPECT_EQ(bins.size(), 30u);
  EXPECT_EQ(bins.front().text, "2 to 2.2");
  EXPECT_EQ(bins.back().text, "7.8 to 8");
  for (const Bin& bin : bins) EXPECT_NEAR(double(bin.count), 1000 * 0.2 / 6, 2);
}

TEST(Bins, OfWholeNumbersHaveThemInTheirMiddle) {
  const std::vector<Bin> few = PutIntoBins(Numbers{6, 6, 8}, AxisKind::kWhole);
  ASSERT_EQ(few.size(), 3u);
  EXPECT_EQ(few[0].text, "6");
  EXPECT_EQ(few[0].low, 5.5);
  EXPECT_EQ((std::vector<int64_t>{few[0].count, few[1].count, few[2].count}),
            (std::vector<int64_t>{2, 0, 1}));
  Numbers hundred;
  for (int i = 0; i < 100; ++i) hundred.push_back(i);
  const std::vector<Bin> many = PutIntoBins(hundred, AxisKind::kWhole);
  ASSERT_EQ(many.size(), 20u);
  EXPECT_EQ(many[1].text, "5 to 9");
  for (const Bin& bin : many) EXPECT_EQ(bin.count, 5);
}

TEST(Bins, OfEqualNumbersIsOne) {
  for (const AxisKind kind : {AxisKind::kLinear, AxisKind::kWhole, AxisKind::kLogarithmic}) {
    for (const double value : {0.0, 1e-320, 1e-7, 7.0, 1e15, 1e100}) {
      if (kind == AxisKind::kLogarithmic && value == 0) continue;
      for (const Numbers& numbers : {Numbers{value}, Numbers{value, value, value * (1 + 1e-15)}}) {
        const std::vector<Bin> bins = PutIntoBins(numbers, kind);
        ASSERT_EQ(bins.size(), 1u) << value;
        EXPECT_LT(bins[0].low, value);
        EXPECT_GT(bins[0].high, value);
        EXPECT_EQ(bins[0].count, std::ssize(numbers));
      }
    }
  }
}

TEST(Bins, OfNumbersFarApart) {
  ExpectBinsHold({-1e100, 0, 1e100}, AxisKind::kLinear);
  ExpectBinsHold({-1e100, 0, 1e100}, AxisKind::kWhole);
  ExpectBinsHold({1e-100, 1, 1e100}, AxisKind::kLogarithmic);
  ExpectBinsHold({0, 1e-99}, AxisKind::kLinear);
  ExpectBinsHold({1e12, 1e12 + 1e5}, AxisKind::kWhole);
}

}  // namespace
}  // namespace shimmer::app
