#include "sim/sigma_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "noise/portable_math.h"
#include "sim/tilt_field.h"

namespace shimmer::sim {
namespace {

constexpr double kPerlinRms = 0.157;          // of 11 octaves, persistence 0.5
constexpr double kTiltRmsOfStrength = 0.247;  // of 8 octaves, persistence 0.5, one axis

// Phi from a table by cubic Hermite interpolation: values and slopes every 1/32, error below 2e-9.
class NormalCdfTable {
 public:
  NormalCdfTable() {
    for (size_t i = 0; i < nodes_.size(); ++i) {
      const double x = -kEnd + static_cast<double>(i) / kPerUnit;
      nodes_[i] = {noise::NormalCdf(x), 0.3989422804014327 * noise::Exp(-0.5 * x * x) / kPerUnit};
    }
  }

  double operator()(double x) const {
    const double place = (std::clamp(x, -kEnd, kEnd - 1e-9) + kEnd) * kPerUnit;
    const auto i = static_cast<size_t>(place);
    const double u = place - static_cast<double>(i);
    const Node &a = nodes_[i], &b = nodes_[i + 1];
    const double rise = b.value - a.value;
    return a.value +
           u * (a.slope + u * (3 * rise - 2 * a.slope - b.slope + u * (a.slope + b.slope - 2 * rise)));
  }

 private:
  static constexpr double kEnd = 7, kPerUnit = 32;
  struct Node {
    double value, slope;
  };
  std::array<Node, static_cast<size_t>(2 * kEnd * kPerUnit) + 1> nodes_;
};

}  // namespace

BlurNoise::BlurNoise(const BlurParams& blur, LatticeKind lattice, ClipKey key)
    : octaves_(MakeOctaves({.octaves = blur.octaves,
                            .base_frequency = blur.base_frequency,
                            .temporal_scale = blur.temporal_scale,
                            .lacunarity = blur.lacunarity,
                            .persistence = blur.persistence},
                           lattice, key, "blur")) {}

void AddPerlinPart(std::span<const float> m, double scale_px, std::span<float> sigma) {
  static const NormalCdfTable normal_cdf;
  for (size_t i = 0; i < sigma.size(); ++i)
    sigma[i] += static_cast<float>(scale_px * normal_cdf(m[i] / kPerlinRms));
}

void AddTiltPart(std::span<const float> dx, std::span<const float> dy, double strength_px, double scale_px,
                 std::span<float> sigma) {
  for (size_t i = 0; i < sigma.size(); ++i)
    sigma[i] += static_cast<float>(scale_px * Tilt01(dx[i], dy[i], strength_px));
}

double Perlin01(double m) { return noise::NormalCdf(m / kPerlinRms); }

double Tilt01(double dx, double dy, double strength_px) {
  const double rms = kTiltRmsOfStrength * strength_px;
  const double x = dx / rms, y = dy / rms;  // divided first: the square of a tiny strength would be 0
  return 1 - noise::Exp(-0.5 * (x * x + y * y));
}

}  // namespace shimmer::sim
