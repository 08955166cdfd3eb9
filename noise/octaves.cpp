#include "noise/octaves.h"

#include <algorithm>
#include <bit>
#include <string>

#include "noise/perlin_double.h"
#include "noise/simplex_double.h"

namespace shimmer::noise {
namespace {

// Octaves with their amplitudes and steps; lattices and origins are filled in by the caller.
std::vector<Octave> Steps(const OctaveParams& params) {
  double sum = 0, share = 1;
  for (int i = 0; i < params.octaves; ++i, share *= params.persistence) sum += share;

  std::vector<Octave> octaves(params.octaves);
  const Fixed lacunarity = Fixed::FromDouble(params.lacunarity),
              time = Fixed::FromDouble(params.temporal_scale);
  Fixed frequency = Fixed::FromDouble(params.base_frequency);
  share = 1;
  for (Octave& octave : octaves) {
    octave.amplitude = static_cast<float>(params.peak * share / sum);
    octave.step_px = frequency.Reduced();
    octave.step_frame = (frequency * time).Reduced();
    frequency = frequency * lacunarity;
    share *= params.persistence;
  }
  return octaves;
}

struct Place {
  Fixed x, y, z;  // reduced
};

// Where a pixel lies on an octave's lattice. Steps are below 2^10 cells, so their products with 53-bit
// integers are exact.
Place PlaceOf(const Octave& octave, int64_t t, int64_t y, int64_t x) {
  return {(octave.origin[0] + octave.step_px * x).Reduced(),
          (octave.origin[1] + octave.step_px * y).Reduced(),
          (octave.origin[2] + octave.step_frame * t).Reduced()};
}

template <class Step>
std::vector<SpacedSteps<Step>> StepsOf(const std::vector<Octave>& octaves) {
  std::vector<SpacedSteps<Step>> steps(octaves.size());
  for (size_t i = 0; i < octaves.size(); ++i)
    for (int64_t spacing = 1; spacing <= kWidestSpacing; spacing *= 2)
      steps[i].emplace_back(octaves[i].step_px * spacing);
  return steps;
}

template <class Step>
const Step& StepOf(const SpacedSteps<Step>& steps, int64_t spacing_px) {
  return steps[std::countr_zero(static_cast<uint64_t>(spacing_px))];
}

}  // namespace

std::vector<Octave> ClassicOctaves(const OctaveParams& params, const Origin& origin) {
  std::vector<Octave> octaves = Steps(params);
  const Fixed lacunarity = Fixed::FromDouble(params.lacunarity);
  Origin scaled = origin;  // l^i o: reduced only where it is used, for l need not be whole
  for (Octave& octave : octaves) {
    octave.permutation = ClassicPermutation();
    for (size_t axis = 0; axis < 3; ++axis) {
      octave.origin[axis] = scaled[axis].Reduced();
      scaled[axis] = scaled[axis] * lacunarity;
    }
  }
  return octaves;
}

std::vector<Octave> SeededOctaves(const OctaveParams& params, uint64_t seed, uint64_t clip,
                                  std::string_view path) {
  std::vector<Octave> octaves = Steps(params);
  for (size_t i = 0; i < octaves.size(); ++i) {
    HashStream stream(HashPath(seed, clip, std::string(path) + ".octave." + std::to_string(i)));
    octaves[i].permutation = ShuffledPermutation(stream);
    octaves[i].origin = RandomOrigin(stream);
  }
  return octaves;
}

Origin RandomOrigin(HashStream& stream) {
  constexpr int kFractionBits = 43;  // with 10 bits of cell, the 53 that a double holds
  Origin origin;
  for (Fixed& coordinate : origin) {
    const uint64_t place = stream.Below(uint64_t{kPeriodCells} << kFractionBits);
    coordinate = Fixed::FromBits(int128{place} << (64 - kFractionBits));
  }
  return origin;
}

SimplexOctaves::SimplexOctaves(std::vector<Octave> octaves, SimplexKernel kernel)
    : octaves_(std::move(octaves)), steps_(StepsOf<SimplexStep>(octaves_)), kernel_(kernel) {
  for (const Octave& octave : octaves_) tables_.emplace_back(octave.permutation);
}

void SimplexOctaves::Row(int64_t t, int64_t y, int64_t x0, std::span<float> out) const {
  std::ranges::fill(out, 0.0f);
  for (size_t i = octaves_.size(); i-- > 0;) AddOctave(i, t, y, x0, 1, out);
}

void SimplexOctaves::AddOctave(size_t i, int64_t t, int64_t y, int64_t x0, int64_t spacing_px,
                               std::span<float> out) const {
  const Octave& octave = octaves_[i];
  const Place p = PlaceOf(octave, t, y * spacing_px, 0);
  AddSimplexRow(tables_[i], kernel_, p.x, StepOf(steps_[i], spacing_px), p.y, p.z, octave.amplitude, x0, out);
}

double SimplexOctaves::Double(int64_t t, int64_t y, int64_t x) const {
  double sum = 0;
  for (const Octave& octave : octaves_) {
    const Place p = PlaceOf(octave, t, y, x);
    sum += octave.amplitude *
           SimplexDouble(octave.permutation, kernel_, p.x.ToDouble(), p.y.ToDouble(), p.z.ToDouble());
  }
  return sum;
}

PerlinOctaves::PerlinOctaves(std::vector<Octave> octaves)
    : octaves_(std::move(octaves)), steps_(StepsOf<PerlinStep>(octaves_)) {}

void PerlinOctaves::Row(int64_t t, int64_t y, int64_t x0, std::span<float> out) const {
  std::ranges::fill(out, 0.0f);
  for (size_t i = octaves_.size(); i-- > 0;) AddOctave(i, t, y, x0, 1, out);
}

void PerlinOctaves::AddOctave(size_t i, int64_t t, int64_t y, int64_t x0, int64_t spacing_px,
                              std::span<float> out) const {
  const Octave& octave = octaves_[i];
  const Place p = PlaceOf(octave, t, y * spacing_px, 0);
  AddPerlinRow(octave.permutation, p.x, StepOf(steps_[i], spacing_px), p.y, p.z, octave.amplitude, x0, out);
}

double PerlinOctaves::Double(int64_t t, int64_t y, int64_t x) const {
  double sum = 0;
  for (const Octave& octave : octaves_) {
    const Place p = PlaceOf(octave, t, y, x);
    sum +=
        octave.amplitude * PerlinDouble(octave.permutation, p.x.ToDouble(), p.y.ToDouble(), p.z.ToDouble());
  }
  return sum;
}

}  // namespace shimmer::noise
