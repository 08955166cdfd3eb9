// The tables of interpolation errors, searched again: what they promise is not exceeded, nor much too large.
#include "noise/interpolation_error.h"

#include <gtest/gtest.h>

#include <functional>

#include "noise/perlin_double.h"
#include "noise/simplex_double.h"
#include "tests/noise/worst_error.h"

namespace shimmer::noise {
namespace {

constexpr NoiseKind kKinds[] = {NoiseKind::kSimplex06, NoiseKind::kSimplex05, NoiseKind::kPerlin};
constexpr double kSteps[] = {2, 4, 5.5, 8.4, 13, 28, 200};

// The search is short, so what it finds lies below the worst; but not far, or the tables are too generous.
constexpr double kFoundShare = 0.5;

void ExpectWithin(const FoundError& found, const NoiseError& promised, double steps,
                  const std::string& what) {
  EXPECT_LE(found.max, promised.max) << what << ", steps a cell " << steps;
  EXPECT_LE(found.rms, promised.rms) << what << ", steps a cell " << steps;
  if (steps < 64) {  // the tables end there
    EXPECT_GE(found.max, kFoundShare * promised.max) << what << ", steps a cell " << steps;
  }
}

Point5 AtPixels(Point5 at, int spacing_px) {
  for (double& v : {std::ref(at[3]), std::ref(at[4])})
    v = std::min(spacing_px - 1.0, std::floor(v * spacing_px)) / spacing_px;
  return at;
}

TEST(InterpolationError, OfGridsIsWithinTheTable) {
  for (const NoiseKind kind : kKinds)
    for (const double steps : kSteps)
      for (const int spacing : {2, 4, 64}) {
        const auto error = [&](const Point5& at) {
          return GridError(kind, 1 / steps, AtPixels(at, spacing));
        };
        ExpectWithin(SearchError(error, 400, 5, 120, 17), GridError(kind, spacing, steps), steps,
                     std::to_string(static_cast<int>(kind)) + " spacing " + std::to_string(spacing));
      }
}

TEST(InterpolationError, BetweenKeyFramesIsWithinTheTable) {
  for (const NoiseKind kind : kKinds)
    for (const double steps : kSteps) {
      const auto error = [&](const Point5& at) { return KeyError(kind, 1 / steps, at); };
      ExpectWithin(SearchError(error, 4000, 10, 400, 17), KeyFrameError(kind, steps), steps,
                   std::to_string(static_cast<int>(kind)) + " key frames");
    }
}

TEST(InterpolationError, OfDroppedNoiseIsItsSize) {
  for (const NoiseKind kind : kKinds) {
    const auto value = [&](const Point5& at) {
      ErrorAtPlace error(kind);
      error.Add(at[0], at[1], at[2], 1);
      return error;
    };
    const FoundError found = SearchError(value, 20000, 10, 500);
    EXPECT_LE(found.max, SizeOf(kind).max);
    EXPECT_GE(found.max, 0.99 * SizeOf(kind).max);
    EXPECT_LE(found.rms, SizeOf(kind).rms);
  }
}

// The search's own noise is the noise: its worst over gradients bounds the twin at every place, and is
// reached.
TEST(InterpolationError, TheSearchKnowsTheNoise) {
  HashStream stream(1);
  for (const NoiseKind kind : kKinds) {
    double closest = 0;
    const Permutation table = ShuffledPermutation(stream);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> cells(0, 200), near(-0.3, 0.3);
    for (int i = 0; i < 100000; ++i) {
      const double x = cells(random), y = cells(random), z = cells(random);
      ErrorAtPlace error(kind);
      error.Add(x, y, z, 1);
      const double twin = kind == NoiseKind::kPerlin ? PerlinDouble(table, x, y, z)
                                                     : SimplexDouble(table, KernelOf(kind), x, y, z);
      ASSERT_LE(std::abs(twin), error.Worst() + 1e-12);
      closest = std::max(closest, std::abs(twin) / error.Worst());
    }
    EXPECT_GT(closest, 0.99);
  }
}

}  // namespace
}  // namespace shimmer::noise
