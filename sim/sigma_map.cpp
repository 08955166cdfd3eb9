#include "sim/sigma_map.h"

#include "noise/portable_math.h"
#include "sim/tilt_field.h"

namespace shimmer::sim {

BlurNoise::BlurNoise(const BlurParams& blur, LatticeKind lattice, ClipKey key)
    : octaves_(MakeOctaves(SumOf(blur), lattice, key, "blur")) {}

noise::OctaveParams SumOf(const BlurParams& blur) {
  return {.octaves = blur.octaves,
          .base_frequency = blur.base_frequency,
          .temporal_scale = blur.temporal_scale,
          .lacunarity = blur.lacunarity,
          .persistence = blur.persistence};
}

double Perlin01(double m) { return noise::NormalCdf(m / kPerlinRms); }

double Tilt01(double dx, double dy, double strength_px) {
  const double rms = kTiltRmsOfStrength * strength_px;
  const double x = dx / rms, y = dy / rms;  // divided first: the square of a tiny strength would be 0
  return 1 - noise::Exp(-0.5 * (x * x + y * y));
}

}  // namespace shimmer::sim
