#include "sim/sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace shimmer::sim {
namespace {

constexpr ClipKey kKey{0, 5};

struct Moments {
  double mean = 0, variance = 0;
};

// Of a constant sample over 400,000 pixels of several frames, rows and channels: the variance of a variance
// is 2 / n of its square for normal noise, so that 1 % is 4.5 of its standard deviations.
Moments MomentsOf(const SensorParams& sensor, float sample) {
  constexpr int kRow = 1000, kRows = 400;
  double sum = 0, squares = 0;
  for (int y = 0; y < kRows; ++y) {
    std::vector<float> row(kRow, sample);
    SenseRow(sensor, kKey, y % 7, y, y % 3, 0, row);
    for (const float value : row) sum += value, squares += double{value} * value;
  }
  const double n = kRow * kRows, mean = sum / n;
  return {mean, squares / n - mean * mean};
}

TEST(Sensor, PhotonsHaveTheVarianceOfTheirMean) {
  for (const double full_well : {50.0, 1000.0, 20'000.0})
    for (const float sample : {0.02f, 0.1f, 0.5f, 1.0f}) {
      const Moments seen = MomentsOf({.full_well = full_well}, sample);
      const double electrons = sample * full_well;
      EXPECT_NEAR(seen.mean * full_well, electrons, 5 * std::sqrt(electrons / 400'000))
          << full_well << " " << sample;
      // A Poisson variable's fourth moment adds 1 / mean to the 2 of a normal one.
      const double spread = std::sqrt((2 + 1 / electrons) / 400'000);
      EXPECT_NEAR(seen.variance * full_well * full_well / electrons, 1, std::max(0.01, 4.5 * spread))
          << full_well << " " << sample;
    }
}

TEST(Sensor, ReadNoiseIsTheSameEverywhere) {
  for (const float sample : {0.0f, 0.3f, 1.0f}) {
    const Moments seen = MomentsOf({.read_noise = 4}, sample);
    EXPECT_NEAR(seen.mean, sample, 5 * 4 / 255.0 / std::sqrt(400'000));
    EXPECT_NEAR(std::sqrt(seen.variance) * 255, 4, 0.02);
  }
  const Moments both = MomentsOf({.full_well = 1000, .read_noise = 4}, 0.5f);
  EXPECT_NEAR(both.variance / (0.5 / 1000 + 16 / 255.0 / 255.0), 1, 0.01) << "they are independent";
}

TEST(Sensor, AVeilTakesContrast) {
  std::vector<float> row = {0, 0.5f, 1};
  SenseRow({.veil = 0.25, .veil_level = 0.6}, kKey, 0, 0, 0, 0, row);
  EXPECT_FLOAT_EQ(row[0], 0.15f);
  EXPECT_FLOAT_EQ(row[1], 0.525f);
  EXPECT_FLOAT_EQ(row[2], 0.9f);
}

TEST(Sensor, QuantisationIsToItsBits) {
  std::vector<float> row;
  for (int i = -20; i < 1020; ++i) row.push_back(static_cast<float>(i) / 1000);
  std::vector<float> seen = row;
  SenseRow({.bits = 4}, kKey, 0, 0, 0, 0, seen);
  EXPECT_EQ(std::set<float>(seen.begin(), seen.end()).size(), 16u);
  for (size_t i = 0; i < row.size(); ++i)
    EXPECT_NEAR(seen[i], std::clamp(row[i], 0.0f, 1.0f), 0.5 / 15 + 1e-6);
}

// Wherever a row begins, and nowhere else the same.
TEST(Sensor, NoiseIsAFunctionOfThePlace) {
  const SensorParams sensor{.full_well = 500, .read_noise = 2};
  const auto noise = [&](ClipKey key, int64_t t, int y, int channel, int x0, size_t count) {
    std::vector<float> row(count, 0.5f);
    SenseRow(sensor, key, t, y, channel, x0, row);
    return row;
  };
  const auto whole = noise(kKey, 3, 4, 1, 0, 100), part = noise(kKey, 3, 4, 1, 40, 20);
  EXPECT_TRUE(std::equal(part.begin(), part.end(), whole.begin() + 40));
  EXPECT_EQ(noise(kKey, 3, 4, 1, 0, 100), whole);
  std::set<std::vector<float>> all = {whole};
  for (const auto& other :
       {noise({1, 5}, 3, 4, 1, 0, 100), noise({0, 6}, 3, 4, 1, 0, 100), noise(kKey, 2, 4, 1, 0, 100),
        noise(kKey, 3, 5, 1, 0, 100), noise(kKey, 3, 4, 2, 0, 100), noise(kKey, 3, 4, 1, 1, 100)})
    all.insert(other);
  EXPECT_EQ(all.size(), 7u);
}

TEST(Sensor, OffItChangesNothing) {
  EXPECT_FALSE(SensorParams().On());
  std::vector<float> row = {-0.1f, 0.2f, 7};
  SenseRow({}, kKey, 0, 0, 0, 0, row);
  EXPECT_EQ(row, (std::vector<float>{-0.1f, 0.2f, 7}));
  SenseRow({.full_well = 100}, kKey, 0, 0, 0, 0, row);
  EXPECT_EQ(row[0], -0.1f) << "undershoot has no photons";
}

}  // namespace
}  // namespace shimmer::sim
