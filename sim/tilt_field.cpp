#include "sim/tilt_field.h"

#include <string>

#include "noise/hash.h"

namespace shimmer::sim {
namespace {

noise::SimplexOctaves AxisOctaves(const TiltParams& tilt, ClipKey key, std::string_view path) {
  return {MakeOctaves(SumOf(tilt), tilt.lattice, key, path), tilt.Kernel()};
}

}  // namespace

noise::OctaveParams SumOf(const TiltParams& tilt) {
  return {.octaves = tilt.octaves,
          .base_frequency = tilt.base_frequency,
          .temporal_scale = tilt.temporal_scale,
          .lacunarity = tilt.lacunarity,
          .persistence = tilt.persistence,
          .peak = tilt.strength_px};
}

std::vector<noise::Octave> MakeOctaves(const noise::OctaveParams& params, LatticeKind lattice, ClipKey key,
                                       std::string_view path) {
  if (lattice == LatticeKind::kSeeded) return noise::SeededOctaves(params, key.seed, key.clip, path);
  noise::HashStream stream(noise::HashPath(key.seed, key.clip, std::string(path) + ".origin"));
  return noise::ClassicOctaves(params, noise::RandomOrigin(stream));
}

TiltField::TiltField(const TiltParams& params, ClipKey key)
    : x_(AxisOctaves(params, key, "tilt.x")), y_(AxisOctaves(params, key, "tilt.y")) {}

}  // namespace shimmer::sim
