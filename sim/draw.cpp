#include "sim/draw.h"

#include <algorithm>
#include <numeric>

#include "noise/hash.h"
#include "noise/portable_math.h"

namespace shimmer::sim {

double DrawUnit(ClipKey key, std::string_view path) {
  return noise::UnitFromBits(noise::HashPath(key.seed, key.clip, path));
}

double DrawUniform(ClipKey key, std::string_view path, double low, double high) {
  return std::clamp(low + (high - low) * DrawUnit(key, path), low, high);
}

double DrawLogUniform(ClipKey key, std::string_view path, double low, double high) {
  return std::clamp(noise::Exp(DrawUniform(key, path, noise::Log(low), noise::Log(high))), low, high);
}

double DrawNormal(ClipKey key, std::string_view path, double mean, double sd, double low, double high) {
  if (sd == 0) return std::clamp(mean, low, high);
  const double below = noise::NormalCdf((low - mean) / sd), up_to = noise::NormalCdf((high - mean) / sd);
  const double p = std::clamp(DrawUniform(key, path, below, up_to), 1e-16, 1 - 1e-16);
  return std::clamp(mean + sd * noise::NormalQuantile(p), low, high);
}

int64_t DrawInteger(ClipKey key, std::string_view path, int64_t low, int64_t high) {
  noise::HashStream stream(noise::HashPath(key.seed, key.clip, path));
  return low + static_cast<int64_t>(stream.Below(static_cast<uint64_t>(high - low) + 1));
}

size_t DrawIndex(ClipKey key, std::string_view path, std::span<const double> weights) {
  double left = DrawUnit(key, path) * std::accumulate(weights.begin(), weights.end(), 0.0);
  size_t last = 0;  // of the indices that can be drawn: rounding may leave a rest after the last of them
  for (size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0) continue;
    if (left < weights[i]) return i;
    left -= weights[i];
    last = i;
  }
  return last;
}

}  // namespace shimmer::sim
