// Octaves of noise over pixels and frames:
//   sum_{i < K} a_i n_i(l^i (f x, f y, f v t) + o_i),   a_i = peak p^i / sum_k p^k.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "noise/fixed.h"
#include "noise/lattice.h"
#include "noise/perlin.h"
#include "noise/simplex.h"

namespace shimmer::noise {

using Origin = std::array<Fixed, 3>;  // cells along x, y, t, each in [0, kPeriodCells)

struct Octave {
  float amplitude;
  Fixed step_px, step_frame;  // cells per px and per frame, reduced
  Origin origin;
  Permutation permutation;
};

struct OctaveParams {
  int octaves = 8;
  double base_frequency = 0.03;  // f, cells per px of octave 0
  double temporal_scale = 1;     // v: time runs f v cells a frame in octave 0
  double lacunarity = 2;
  double persistence = 0.5;
  double peak = 1;  // bound on the sum for noise in [-1, 1]
};

// classic: one table (Perlin's) and one origin o, o_i = l^i o, as the fractal sums of the noise library.
std::vector<Octave> ClassicOctaves(const OctaveParams& params, const Origin& origin);

// seeded: a table and an origin of its own for each octave, from the hash of (seed, clip, path).
std::vector<Octave> SeededOctaves(const OctaveParams& params, uint64_t seed, uint64_t clip,
                                  std::string_view path);

// An origin anywhere in the period, from a stream; its coordinates are doubles without loss.
Origin RandomOrigin(HashStream& stream);

// Steps of an octave by spacing, a power of two up to kWidestSpacing: the logarithm is the index.
inline constexpr int kWidestSpacing = 64;
template <class Step>
using SpacedSteps = std::vector<Step>;

// The sum with simplex noise, or with Perlin noise, as a row of pixels: float32, from the last octave to the
// first.
class SimplexOctaves {
 public:
  SimplexOctaves(std::vector<Octave> octaves, SimplexKernel kernel);
  void Row(int64_t t, int64_t y, int64_t x0,
           std::span<float> out) const;                  // pixels x0 .. of row y, frame t; writes out
  double Double(int64_t t, int64_t y, int64_t x) const;  // the twin of one pixel
  // Adds octave i alone, at every spacing_px-th pixel: those at (x0 .., y) spacing_px. spacing_px: a power of
  // two, at most kWidestSpacing.
  void AddOctave(size_t i, int64_t t, int64_t y, int64_t x0, int64_t spacing_px, std::span<float> out) const;
  const SimplexKernel& kernel() const { return kernel_; }
  const std::vector<Octave>& octaves() const { return octaves_; }

 private:
  std::vector<Octave> octaves_;
  std::vector<SimplexTable> tables_;
  std::vector<SpacedSteps<SimplexStep>> steps_;
  SimplexKernel kernel_;
};

class PerlinOctaves {
 public:
  explicit PerlinOctaves(std::vector<Octave> octaves);
  void Row(int64_t t, int64_t y, int64_t x0, std::span<float> out) const;
  double Double(int64_t t, int64_t y, int64_t x) const;
  void AddOctave(size_t i, int64_t t, int64_t y, int64_t x0, int64_t spacing_px, std::span<float> out) const;
  const std::vector<Octave>& octaves() const { return octaves_; }

 private:
  std::vector<Octave> octaves_;
  std::vector<SpacedSteps<PerlinStep>> steps_;
};

}  // namespace shimmer::noise
