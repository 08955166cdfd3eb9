// How wide each output pixel's Gaussian is.
//   sigma    = sigma_min + (sigma_max - sigma_min) ((1 - w) perlin01 + w tilt01)
//   perlin01 = Phi(m / 0.157)                              m: octaves of Perlin noise, of RMS 0.157
//   tilt01   = 1 - exp(-|d|^2 / (2 (0.247 S)^2))           d: the pixel's tilt, of RMS 0.247 S an axis
// Both maps are fixed: a map by the frame's own extremes would flicker from frame to frame.
#pragma once

#include <span>

#include "noise/octaves.h"
#include "sim/draw.h"
#include "sim/scene.h"

namespace shimmer::sim {

inline constexpr double kPerlinRms = 0.157;          // of 11 octaves, persistence 0.5
inline constexpr double kTiltRmsOfStrength = 0.247;  // of 8 octaves, persistence 0.5, along one axis

// The Perlin part of the map, for one clip. Any order, any thread, same bits.
class BlurNoise {
 public:
  BlurNoise(const BlurParams& params, LatticeKind lattice, ClipKey key);

  // Writes m of pixels x0 .. of row y in frame t.
  void Row(int64_t t, int64_t y, int64_t x0, std::span<float> m) const { octaves_.Row(t, y, x0, m); }
  double Double(int64_t t, int64_t y, int64_t x) const { return octaves_.Double(t, y, x); }
  const noise::PerlinOctaves& octaves() const { return octaves_; }

 private:
  noise::PerlinOctaves octaves_;
};

// The sum of octaves that m is.
noise::OctaveParams SumOf(const BlurParams& blur);

// sigma += scale_px Phi(m / 0.157), and sigma += scale_px (1 - exp(-(dx^2 + dy^2) / (2 (0.247
// strength_px)^2))). Error below 1e-6 scale_px.
void AddPerlinPart(std::span<const float> m, double scale_px, std::span<float> sigma);
void AddTiltPart(std::span<const float> dx, std::span<const float> dy, double strength_px, double scale_px,
                 std::span<float> sigma);

// The double twins, of one pixel.
double Perlin01(double m);
double Tilt01(double dx, double dy, double strength_px);

}  // namespace shimmer::sim
