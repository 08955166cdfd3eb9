#include "sim/sigma_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace shimmer::sim {
namespace {

TEST(SigmaMap, PerlinPartEqualsItsTwin) {
  std::vector<float> m, sigma;
  for (float v = -1.2f; v <= 1.2f; v += 0.00037f) m.push_back(v);
  sigma.assign(m.size(), 0.5f);
  AddPerlinPart(m, 6, sigma);
  for (size_t i = 0; i < m.size(); ++i) EXPECT_NEAR(sigma[i], 0.5 + 6 * Perlin01(m[i]), 6e-6);
  EXPECT_NEAR(Perlin01(0), 0.5, 1e-15);
  EXPECT_NEAR(Perlin01(0.157), 0.841344746068543, 1e-12);  // Phi(1)
}

TEST(SigmaMap, TiltPartEqualsItsTwinDownToTinyStrengths) {
  for (double strength : {5.0, 1e-6, 1e-30, 64.0}) {
    std::vector<float> dx, dy, sigma;
    for (int i = -50; i <= 50; ++i)
      dx.push_back(static_cast<float>(strength * i / 50)),
          dy.push_back(static_cast<float>(strength * (50 - i) / 100));
    sigma.assign(dx.size(), 0.0f);
    AddTiltPart(dx, dy, strength, 2, sigma);
    for (size_t i = 0; i < dx.size(); ++i) {
      EXPECT_NEAR(sigma[i], 2 * Tilt01(dx[i], dy[i], strength), 1e-6);
      EXPECT_GE(sigma[i], 0);
      EXPECT_LE(sigma[i], 2);
    }
  }
  EXPECT_EQ(Tilt01(0, 0, 5), 0);
  EXPECT_NEAR(Tilt01(0.247 * 5, 0, 5), 1 - std::exp(-0.5), 1e-12);
}

// Phi of a field of RMS 0.157 is spread over [0, 1]: both ends are reached, the mean is a half, and the map
// of one frame does not depend on the frame's own extremes.
TEST(SigmaMap, ReachesBothEnds) {
  const BlurNoise noise({.base_frequency = 0.0317, .temporal_scale = 20}, LatticeKind::kSeeded, {0, 0});
  std::vector<float> m(2000), all;
  for (int64_t line = 0; line < 200; ++line) {
    noise.Row(line, 101 * line, 0, m);
    std::vector<float> sigma(m.size(), 0.0f);
    AddPerlinPart(m, 1, sigma);
    all.insert(all.end(), sigma.begin(), sigma.end());
  }
  const auto [low, high] = std::ranges::minmax(all);
  double sum = 0;
  for (float v : all) sum += v;
  EXPECT_LT(low, 0.01);
  EXPECT_GT(high, 0.99);
  EXPECT_NEAR(sum / static_cast<double>(all.size()), 0.5, 0.03);
}

}  // namespace
}  // namespace shimmer::sim
