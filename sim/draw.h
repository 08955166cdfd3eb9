// Drawn parameters: each a function of (seed, clip, path) alone, so that adding one changes no other, and a
// clip drawn alone equals the same clip in a run of 100,000. The same bits on every machine: no libm (DESIGN
// "Numbers").
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace shimmer::sim {

struct ClipKey {
  uint64_t seed;  // of the data set; 0 is a seed
  uint64_t clip;  // index in the data set
};

// path is the parameter's name in the config, "tilt.strength_px".
double DrawUnit(ClipKey key, std::string_view path);                                 // [0, 1), 53 bits
double DrawUniform(ClipKey key, std::string_view path, double low, double high);     // [low, high]
double DrawLogUniform(ClipKey key, std::string_view path, double low, double high);  // 0 < low <= high
// Normal(mean, sd) cut to [low, high] (drawn from the cut distribution itself, so the ends collect no mass).
double DrawNormal(ClipKey key, std::string_view path, double mean, double sd, double low, double high);
int64_t DrawInteger(ClipKey key, std::string_view path, int64_t low,
                    int64_t high);  // [low, high], both drawn
size_t DrawIndex(ClipKey key, std::string_view path, std::span<const double> weights);  // by weight, sum > 0

}  // namespace shimmer::sim
