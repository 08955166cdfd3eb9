// Random numbers by counting: every number is a function of (seed, clip, path) and its place in a stream, so
// nothing depends on what was drawn before it, on threads, or on the order of clips.
#pragma once

#include <cstdint>
#include <string_view>

namespace shimmer::noise {

// SipHash-2-4 (Aumasson and Bernstein 2012) of the path's bytes under the key (seed, clip): 64 bits without
// known structure.
uint64_t HashPath(uint64_t seed, uint64_t clip, std::string_view path);

// The numbers that follow from one key: SplitMix64 (Steele, Lea and Flood 2014).
class HashStream {
 public:
  explicit HashStream(uint64_t key) : state_(key) {}

  uint64_t Next() {
    uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }

  // Uniform in [0, bound), bound > 0. Bias below bound / 2^64.
  uint64_t Below(uint64_t bound) {
    return static_cast<uint64_t>((static_cast<unsigned __int128>(Next()) * bound) >> 64);
  }

 private:
  uint64_t state_;
};

// The 53 high bits as a double in [0, 1).
inline double UnitFromBits(uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace shimmer::noise
