// What the fields look like in the large: the figures that DESIGN section 1 builds on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "noise/octaves.h"
#include "noise/simplex_double.h"

namespace shimmer::noise {
namespace {

struct Moments {
  double mean = 0, variance = 0, max = 0;
};

// About 8 points a cell, and no fraction that its octaves repeat: a step of 1/8 cell would see the same 8
// fractions for ever.
constexpr double kFrequency = 0.1237;

// Rows at least 1.7 cells apart.
template <class Octaves>
Moments Sample(const Octaves& octaves, int64_t first_frame) {
  Moments m;
  std::vector<float> row(4096);
  int64_t points = 0;
  for (int64_t line = 0; line < 500; ++line) {
    octaves.Row(first_frame + line, 14 * line, 0, row);
    for (float v : row)
      m.mean += v, m.variance += v * v, m.max = std::max(m.max, std::abs(double{v})), ++points;
  }
  m.mean /= static_cast<double>(points);
  m.variance = m.variance / static_cast<double>(points) - m.mean * m.mean;
  return m;
}

OctaveParams OneOctave() { return {.octaves = 1, .base_frequency = kFrequency, .temporal_scale = 8}; }

// 256,000 cells, each about one independent value: the variance's own standard error is 0.3 %.
TEST(Statistics, OneSimplexOctave) {
  for (int64_t first_frame : {int64_t{0}, int64_t{1} << 31}) {
    const Moments m =
        Sample(SimplexOctaves(SeededOctaves(OneOctave(), 0, 0, "x"), kSimplexKernel06), first_frame);
    EXPECT_NEAR(m.variance, 0.181, 0.181 * 0.015);
    EXPECT_NEAR(m.mean, 0, 0.01);
    EXPECT_LT(m.max, 1);
    EXPECT_GT(m.max, 0.8);
  }
}

TEST(Statistics, TheOtherKernelHasTheSameRms) {
  const Moments m = Sample(SimplexOctaves(SeededOctaves(OneOctave(), 0, 0, "x"), kSimplexKernel05), 0);
  EXPECT_NEAR(std::sqrt(m.variance), std::sqrt(0.181), 0.01 * std::sqrt(0.181));
}

// RMS of the tilt per axis: 0.247 S for K = 8, p = 0.5.
TEST(Statistics, EightOctavesHaveTheTiltsRms) {
  const OctaveParams params{.octaves = 8, .base_frequency = kFrequency, .temporal_scale = 8};
  EXPECT_NEAR(
      std::sqrt(Sample(SimplexOctaves(SeededOctaves(params, 0, 0, "x"), kSimplexKernel06), 0).variance),
      0.247, 0.004);
}

// RMS of the sigma map's noise: 0.157 for 11 octaves.
TEST(Statistics, ElevenPerlinOctavesHaveTheSigmaMapsRms) {
  const OctaveParams params{.octaves = 11, .base_frequency = kFrequency, .temporal_scale = 8};
  EXPECT_NEAR(std::sqrt(Sample(PerlinOctaves(SeededOctaves(params, 0, 0, "x")), 0).variance), 0.157, 0.004);
}

TEST(Statistics, AxesAreIndependent) {
  const SimplexOctaves x(SeededOctaves(OneOctave(), 0, 0, "tilt.x"), kSimplexKernel06),
      y(SeededOctaves(OneOctave(), 0, 0, "tilt.y"), kSimplexKernel06);
  std::vector<float> row_x(4096), row_y(4096);
  double sum = 0;
  for (int64_t line = 0; line < 500; ++line) {
    x.Row(line, 14 * line, 0, row_x), y.Row(line, 14 * line, 0, row_y);
    for (size_t i = 0; i < row_x.size(); ++i) sum += row_x[i] * row_y[i];
  }
  EXPECT_NEAR(sum / (500 * 4096 * 0.181), 0, 0.01);  // correlation; 256,000 independent values give 0.002
}

// The bound that the plan's margins build on: at random places, the corners' contributions with the gradients
// that suit them best. 0.9787 and 1.0835 are the maxima of a search by refinement.
TEST(Statistics, KernelsStayWithinTheirBounds) {
  HashStream stream(0);
  for (const SimplexKernel& kernel : {kSimplexKernel06, kSimplexKernel05}) {
    double most = 0;
    for (int i = 0; i < 300000; ++i) {
      double f[3] = {UnitFromBits(stream.Next()), UnitFromBits(stream.Next()), UnitFromBits(stream.Next())};
      std::sort(f, f + 3, std::greater<>());
      const double unskew = (f[0] + f[1] + f[2]) / 6;
      double sum = 0;
      for (int corner = 0; corner <= 3;
           ++corner) {  // (0,0,0), (1,0,0), (1,1,0), (1,1,1) for descending fractions
        double p[3], distance2 = 0, best = 0;
        for (int a = 0; a < 3; ++a)
          p[a] = f[a] - unskew - (a < corner) + corner / 6.0, distance2 += p[a] * p[a];
        for (int g = 0; g < 12; ++g)
          best = std::max(best, kGradients[g][0] * p[0] + kGradients[g][1] * p[1] + kGradients[g][2] * p[2]);
        sum += std::pow(std::max(0.0, kernel.radius2 - distance2), 4) * best;
      }
      most = std::max(most, kernel.scale * sum);
    }
    EXPECT_LE(most, kernel.bound);
    EXPECT_GT(most, 0.95 * kernel.bound);
  }
}

// snoise3's kernel jumps where simplices meet: by up to 0.0064. The 0.5 kernel does not.
TEST(Statistics, OnlyThe06KernelJumps) {
  HashStream stream(0);
  double jump06 = 0, jump05 = 0;
  for (int i = 0; i < 20000; ++i) {
    // A point on the face u = v of its cell, that is x = y, and its two sides
    const double x = UnitFromBits(stream.Next()) * 100, z = UnitFromBits(stream.Next()) * 100, d = 1e-9;
    const auto jump = [&](const SimplexKernel& k) {
      return std::abs(SimplexDouble(ClassicPermutation(), k, x + d, x - d, z) -
                      SimplexDouble(ClassicPermutation(), k, x - d, x + d, z));
    };
    jump06 = std::max(jump06, jump(kSimplexKernel06)), jump05 = std::max(jump05, jump(kSimplexKernel05));
  }
  EXPECT_GT(jump06, 0.004);
  EXPECT_LT(jump06, 0.0065);
  EXPECT_LT(jump05, 1e-7);
}

}  // namespace
}  // namespace shimmer::noise
