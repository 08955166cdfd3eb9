// The row kernels against their double twins, at far places, odd lengths and every SIMD target.
#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <cmath>
#include <vector>

#include "noise/octaves.h"
#include "noise/perlin.h"
#include "noise/perlin_double.h"
#include "noise/simplex_double.h"

namespace shimmer::noise {
namespace {

// The promise of simplex.h and perlin.h, in units of the amplitude. Slopes reach 7 a cell; a coordinate is
// rounded to 2^-25 twice and the arithmetic is float32.
constexpr double kRowError = 5e-6;
constexpr double kFaceCells = 1e-6;  // points this near a simplex face may fall to either side

struct RowErrors {
  double max = 0;
  int exempt = 0, points = 0;
};

RowErrors SimplexRowErrors(SimplexKernel kernel, Fixed x, Fixed step, Fixed y, Fixed z, size_t count) {
  HashStream stream(count);
  const Permutation permutation = ShuffledPermutation(stream);
  std::vector<float> row(count, 0.0f);
  AddSimplexRow(SimplexTable(permutation), kernel, x, step, y, z, 1.0f, 0, row);
  RowErrors errors;
  for (size_t i = 0; i < count; ++i, ++errors.points) {
    const double px = (x + step * static_cast<int64_t>(i)).Reduced().ToDouble(), py = y.Reduced().ToDouble(),
                 pz = z.Reduced().ToDouble();
    if (SimplexFaceDistance(px, py, pz) < kFaceCells)
      ++errors.exempt;
    else
      errors.max = std::max(errors.max, std::abs(row[i] - SimplexDouble(permutation, kernel, px, py, pz)));
  }
  return errors;
}

struct FarPlace {
  double step_cells;  // per px
  double time_step;   // cells per frame
  int64_t x, y, t;
};

const FarPlace kFarPlaces[] = {
    {1 / 64.0, 0.03, 0, 0, 0},
    {0.015, 0.015 * 0.7, -(1 << 20), 1 << 20, int64_t{1} << 31},
    {0.06 * 128, 0.06 * 4 * 128, 1 << 20, -(1 << 20), (int64_t{1} << 31) - 1},
    {1e-6, 1e-6, 1 << 20, 12345, 1000000},
    {64, 256 - 1e-9, 99999, -1, 1000000000},
    {0.5, 0.5, -1, -1, 1},
};

TEST(SimplexRow, IsWithinItsErrorAtFarPlaces) {
  RowErrors all;
  for (const SimplexKernel& kernel : {kSimplexKernel06, kSimplexKernel05})
    for (const FarPlace& p : kFarPlaces)
      for (int row = 0; row < 40; ++row) {
        const Fixed step = Fixed::FromDouble(p.step_cells), time = Fixed::FromDouble(p.time_step);
        const Fixed x = Fixed::FromDouble(0.123456789 + 7.1 * row), y = Fixed::FromDouble(100.31),
                    z = Fixed::FromDouble(500.77);
        const RowErrors e =
            SimplexRowErrors(kernel, x + step * p.x, step, y + step * (p.y + row), z + time * p.t, 1920);
        EXPECT_LE(e.max, kRowError) << p.step_cells << " row " << row;
        all.exempt += e.exempt, all.points += e.points;
      }
  // Six faces a cell, each exempting 2e-6 of it: 12 in a million, and as much again by chance
  EXPECT_LE(all.exempt, 2 * 12e-6 * all.points);
  RecordProperty("exempt", all.exempt);
}

TEST(PerlinRow, IsWithinItsErrorAtFarPlaces) {
  HashStream stream(0);
  const Permutation permutation = ShuffledPermutation(stream);
  for (const FarPlace& p : kFarPlaces)
    for (int line = 0; line < 40; ++line) {
      const Fixed step = Fixed::FromDouble(p.step_cells), time = Fixed::FromDouble(p.time_step);
      const Fixed x = Fixed::FromDouble(3.3 * line) + step * p.x,
                  y = Fixed::FromDouble(0.7) + step * (p.y + line), z = time * p.t;
      std::vector<float> row(1920, 0.0f);
      AddPerlinRow(permutation, x, step, y, z, 1.0f, 0, row);
      for (size_t i = 0; i < row.size(); ++i) {
        const double twin =
            PerlinDouble(permutation, (x + step * static_cast<int64_t>(i)).Reduced().ToDouble(),
                         y.Reduced().ToDouble(), z.Reduced().ToDouble());
        ASSERT_NEAR(row[i], twin, kRowError) << p.step_cells << " point " << i;
      }
    }
}

TEST(Rows, AddToWhatIsThere) {
  std::vector<float> once(7, 0.0f), onto(7, 2.0f);
  AddPerlinRow(ClassicPermutation(), Fixed::FromDouble(0.3), Fixed::FromDouble(0.1), Fixed::FromDouble(0.2),
               Fixed::FromDouble(0.4), 0.5f, 0, once);
  AddPerlinRow(ClassicPermutation(), Fixed::FromDouble(0.3), Fixed::FromDouble(0.1), Fixed::FromDouble(0.2),
               Fixed::FromDouble(0.4), 0.5f, 0, onto);
  for (size_t i = 0; i < once.size(); ++i) EXPECT_EQ(onto[i], 2.0f + once[i]);
}

SimplexOctaves SomeOctaves(SimplexKernel kernel = kSimplexKernel06) {
  return {
      SeededOctaves({.octaves = 8, .base_frequency = 0.03, .temporal_scale = 2, .peak = 5}, 0, 0, "tilt.x"),
      kernel};
}

// A pixel's value does not depend on the row it was computed in: any length, any start.
TEST(Octaves, ARowIsTheSameWhereverItBegins) {
  const SimplexOctaves octaves = SomeOctaves();
  std::vector<float> whole(1000);
  octaves.Row(3, 5, -200, whole);
  for (size_t start : {0, 1, 63, 64, 65, 500})
    for (size_t count : {1, 2, 17, 64, 129}) {
      std::vector<float> part(count);
      octaves.Row(3, 5, static_cast<int64_t>(start) - 200, part);
      for (size_t i = 0; i < count; ++i) EXPECT_EQ(part[i], whole[start + i]);
    }
}

TEST(Octaves, SumIsWithinItsErrorOfTheTwin) {
  for (const SimplexKernel& kernel : {kSimplexKernel06, kSimplexKernel05}) {
    const SimplexOctaves octaves = SomeOctaves(kernel);
    for (int64_t t : {int64_t{0}, int64_t{1} << 31}) {
      std::vector<float> row(256);
      int outside = 0;
      for (int64_t y = 0; y < 50; ++y) {
        octaves.Row(t, y, 0, row);
        for (size_t x = 0; x < row.size(); ++x)
          outside += std::abs(row[x] - octaves.Double(t, y, static_cast<int64_t>(x))) > 5 * kRowError;
      }
      EXPECT_LE(outside, 10) << t;  // of 12,800: faces, 8 octaves x 1e-5
    }
  }
}

TEST(Octaves, EachHasItsOwnTableAndOrigin) {
  const auto x = SeededOctaves({}, 0, 0, "tilt.x"), y = SeededOctaves({}, 0, 0, "tilt.y"),
             clip1 = SeededOctaves({}, 0, 1, "tilt.x");
  EXPECT_NE(x[0].permutation, x[1].permutation);
  EXPECT_NE(x[0].permutation, y[0].permutation);
  EXPECT_NE(x[0].permutation, clip1[0].permutation);
  EXPECT_NE(x[0].origin, x[1].origin);
  EXPECT_EQ(x[3].permutation, SeededOctaves({}, 0, 0, "tilt.x")[3].permutation);
}

TEST(Octaves, ClassicOnesShareOneTableAndScaleTheOrigin) {
  const Origin origin{Fixed::FromDouble(1.5), Fixed::FromDouble(700), Fixed::FromDouble(0.25)};
  const auto octaves = ClassicOctaves({.octaves = 3, .lacunarity = 2}, origin);
  EXPECT_EQ(octaves[2].permutation, ClassicPermutation());
  EXPECT_EQ(octaves[2].origin[0].ToDouble(), 6);
  EXPECT_EQ(octaves[2].origin[1].ToDouble(), std::fmod(2800, 768));
}

// Rounding sums to exactly the peak in real numbers: K = 8, p = 0.5, also p = 0 and p = 1.
TEST(Octaves, AmplitudesSumToThePeak) {
  for (double persistence : {0.0, 0.5, 1.0}) {
    double sum = 0;
    for (const Octave& octave :
         SeededOctaves({.octaves = 8, .persistence = persistence, .peak = 5}, 0, 0, "a"))
      sum += octave.amplitude;
    EXPECT_NEAR(sum, 5, 5e-6);
  }
}

// Every SIMD target that this machine has gives the same bits.
TEST(Rows, AreTheSameOnEveryTarget) {
  const SimplexOctaves simplex = SomeOctaves();
  const PerlinOctaves perlin(SeededOctaves({.octaves = 11}, 7, 7, "blur"));
  std::vector<float> first_simplex, first_perlin;
  int targets = 0;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    std::vector<float> s(333), p(333);
    simplex.Row(11, 22, 33, s);
    perlin.Row(11, 22, 33, p);
    if (targets++ == 0) first_simplex = s, first_perlin = p;
    EXPECT_EQ(s, first_simplex) << hwy::TargetName(target);
    EXPECT_EQ(p, first_perlin) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GE(targets, 2);
}

}  // namespace
}  // namespace shimmer::noise
