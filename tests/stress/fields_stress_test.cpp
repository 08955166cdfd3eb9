// Fields at the ends of their ranges: far frames, far pixels, origins on the period's edges, extreme
// frequencies.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "noise/octaves.h"
#include "noise/perlin_double.h"
#include "noise/simplex_double.h"

namespace shimmer::noise {
namespace {

constexpr int64_t kFrames[] = {0, 1000000, 1000000000, int64_t{1} << 31};
constexpr int64_t kPlaces_px[] = {-(1 << 20), -1, 0, 1 << 20};
constexpr double kFrequencies[] = {1e-6, 1e-3, 0.015, 0.06, 0.5};
constexpr double kRowError = 5e-6;  // the promise of noise/simplex.h and perlin.h

// An origin's coordinates: the period's edges, the last place before one, a simplex face, anywhere.
constexpr double kOrigins[] = {0, 768 - 0x1p-43, 256, 255.5, 512 + 1.0 / 3, 123.456};

std::vector<Octave> At(std::vector<Octave> octaves, size_t first) {
  constexpr size_t kCount = std::size(kOrigins);
  for (size_t i = 0; i < octaves.size(); ++i)
    for (size_t axis = 0; axis < 3; ++axis)
      octaves[i].origin[axis] = Fixed::FromDouble(kOrigins[(first + i + axis * (first + 1)) % kCount]);
  return octaves;
}

// How near the nearest face is, over all octaves: pixels in 1e-6 cell of one may fall to either side.
double FaceDistance(const std::vector<Octave>& octaves, int64_t t, int64_t y, int64_t x) {
  double nearest = 1;
  for (const Octave& o : octaves)
    nearest = std::min(nearest, SimplexFaceDistance((o.origin[0] + o.step_px * x).Reduced().ToDouble(),
                                                    (o.origin[1] + o.step_px * y).Reduced().ToDouble(),
                                                    (o.origin[2] + o.step_frame * t).Reduced().ToDouble()));
  return nearest;
}

// Every combination of frame, place, frequency, lacunarity and persistence, against the double twin.
TEST(FieldsStress, RowsEqualTheirTwinsEverywhere) {
  std::vector<float> row(97);
  int exempt = 0, points = 0;
  size_t turn = 0;
  for (const int64_t t : kFrames)
    for (const int64_t x : kPlaces_px)
      for (const int64_t y : kPlaces_px)
        for (const double frequency : kFrequencies)
          for (const double lacunarity : {1.0, 1.9, 2.0, 4.0})
            for (const double persistence : {0.0, 0.5, 1.0}) {
              const OctaveParams params{.octaves = 8,
                                        .base_frequency = frequency,
                                        .temporal_scale = turn % 2 == 0 ? 1.3 : 1000,
                                        .lacunarity = lacunarity,
                                        .persistence = persistence};
              const std::vector<Octave> octaves = At(SeededOctaves(params, 0, turn, "stress"), turn);
              ++turn;
              const SimplexOctaves simplex(octaves, turn % 2 == 0 ? kSimplexKernel06 : kSimplexKernel05);
              simplex.Row(t, y, x, row);
              for (size_t i = 0; i < row.size(); i += 8, ++points) {
                const auto at = x + static_cast<int64_t>(i);
                if (FaceDistance(octaves, t, y, at) < 1e-6)
                  ++exempt;
                else
                  ASSERT_NEAR(row[i], simplex.Double(t, y, at), kRowError)
                      << "t " << t << " x " << at << " y " << y << " f " << frequency;
              }
              const PerlinOctaves perlin(octaves);
              perlin.Row(t, y, x, row);
              for (size_t i = 0; i < row.size(); i += 8)
                ASSERT_NEAR(row[i], perlin.Double(t, y, x + static_cast<int64_t>(i)), kRowError);
            }
  // Origins on faces and steps of 1/2 keep many points on faces for ever; most are not.
  EXPECT_LT(exempt, points / 2);
}

// Where float32 coordinates would give neighbours one value, ours differ: as many as at frame 0.
TEST(FieldsStress, NeighboursAreDistinctAtAnyTime) {
  std::vector<float> row(4096);
  for (const int64_t t : kFrames)
    for (const int64_t x : kPlaces_px) {
      const SimplexOctaves octaves(
          SeededOctaves({.octaves = 8, .base_frequency = 0.015, .temporal_scale = 2}, 0, 0, "stress"),
          kSimplexKernel06);
      octaves.Row(t, x, x, row);
      int equal = 0;
      for (size_t i = 1; i < row.size(); ++i) equal += row[i] == row[i - 1];
      EXPECT_LE(equal, 2) << t << " " << x;  // values of 2^-25 steps meet by chance about once in 20 rows
      EXPECT_GT(std::set<float>(row.begin(), row.end()).size(), 4080u);
    }
}

// Variance over 40,000 cells each: its own standard error is about 0.8 %, and 3 % is what is promised.
TEST(FieldsStress, VarianceAtFarTimesIsThatAtZero) {
  const auto variance = [](const auto& octaves, int64_t t) {
    std::vector<float> row(4096);
    double sum = 0, sum2 = 0;
    int64_t points = 0;
    for (int64_t line = 0; line < 200; ++line) {  // rows 2.3 cells apart, 8 pixels a cell
      octaves.Row(t + line, 19 * line, 0, row);
      for (const float v : row) sum += v, sum2 += v * v, ++points;
    }
    const double mean = sum / static_cast<double>(points);
    return sum2 / static_cast<double>(points) - mean * mean;
  };
  const OctaveParams params{.octaves = 8, .base_frequency = 0.1237, .temporal_scale = 8};
  const SimplexOctaves simplex(SeededOctaves(params, 0, 0, "stress"), kSimplexKernel06);
  const PerlinOctaves perlin(SeededOctaves(params, 0, 1, "stress"));
  HashStream stream(0);
  const SimplexOctaves classic(ClassicOctaves(params, RandomOrigin(stream)), kSimplexKernel06);
  for (const int64_t t : {int64_t{1000000}, int64_t{1000000000}, (int64_t{1} << 31) - 200}) {
    EXPECT_NEAR(variance(simplex, t) / variance(simplex, 0), 1, 0.03) << t;
    EXPECT_NEAR(variance(perlin, t) / variance(perlin, 0), 1, 0.03) << t;
    EXPECT_NEAR(variance(classic, t) / variance(classic, 0), 1, 0.03) << t;
  }
}

}  // namespace
}  // namespace shimmer::noise
