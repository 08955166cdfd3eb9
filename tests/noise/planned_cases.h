// Random sums of octaves with their areas, frames and budgets, and how they are rendered.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "noise/hash.h"
#include "noise/planned_octaves.h"
#include "noise/simplex_double.h"

namespace shimmer::noise {

using Values = std::vector<float>;

inline Values Render(const PlannedOctaves::Frame& frame, const PixelArea& area) {
  Values values(static_cast<size_t>(area.width) * area.height);
  for (int y = 0; y < area.height; ++y)
    frame.Row(area.y0 + y, area.x0,
              {values.data() + static_cast<size_t>(y) * area.width, static_cast<size_t>(area.width)});
  return values;
}

template <class Octaves>
Values RenderFull(const Octaves& octaves, const PixelArea& area, int64_t t) {
  Values values(static_cast<size_t>(area.width) * area.height);
  for (int y = 0; y < area.height; ++y)
    octaves.Row(t, area.y0 + y, area.x0,
                {values.data() + static_cast<size_t>(y) * area.width, static_cast<size_t>(area.width)});
  return values;
}

// "full", "dropped", "tile512", "grid4"
inline std::string NameOf(const OctaveWay& way) {
  if (way.kind == OctaveWayKind::kDropped) return "dropped";
  if (way.kind == OctaveWayKind::kTiled) return "tile" + std::to_string(way.period_px);
  if (way.kind == OctaveWayKind::kGrid) return "grid" + std::to_string(way.spacing_px);
  return "full";
}

inline std::string Describe(const FieldPlan& plan) {
  std::string text;
  for (const OctaveWay& way : plan.octaves) text += NameOf(way) + "/" + std::to_string(way.key_frames) + " ";
  return text;
}

struct Case {
  NoiseKind kind;
  OctaveParams params;
  bool classic;
  PixelArea area;
  int frames;
  int64_t t;
  ErrorBudget budget;
};

inline std::vector<Octave> OctavesOf(const Case& c, uint64_t seed) {
  if (!c.classic) return SeededOctaves(c.params, seed, 0, "field");
  HashStream stream(seed);
  return ClassicOctaves(c.params, RandomOrigin(stream));
}

inline double Uniform(HashStream& stream, double low, double high) {
  return low + (high - low) * UnitFromBits(stream.Next());
}

inline Case RandomCase(uint64_t seed) {
  HashStream s(HashPath(seed, 0, "case"));
  const auto log_uniform = [&](double low, double high) {
    return std::exp(Uniform(s, std::log(low), std::log(high)));
  };
  Case c;
  c.kind = static_cast<NoiseKind>(s.Below(3));
  c.classic = s.Below(2);
  c.params.octaves = 1 + static_cast<int>(s.Below(16));
  c.params.base_frequency =
      s.Below(3) ? log_uniform(1e-6, 0.5) : std::exp2(-1.0 - static_cast<double>(s.Below(8)));
  c.params.temporal_scale = s.Below(4) ? log_uniform(1e-3, 10) : 0;
  c.params.lacunarity = s.Below(2) ? 2 : Uniform(s, 1, 4);
  c.params.persistence = s.Below(8) ? Uniform(s, 0, 1) : static_cast<double>(s.Below(2));
  c.params.peak = s.Below(10) ? Uniform(s, 0, 64) : 0;
  const int64_t far = s.Below(2) ? int64_t{1} << 20 : 0;
  c.area = {far - static_cast<int64_t>(s.Below(1000)), -far + static_cast<int64_t>(s.Below(1000)),
            1 + static_cast<int>(s.Below(s.Below(2) ? 400 : 40)),
            1 + static_cast<int>(s.Below(s.Below(2) ? 300 : 30))};
  c.frames = 1 + static_cast<int>(s.Below(200));
  c.t = s.Below(2) ? static_cast<int64_t>(s.Below(100))
                   : (int64_t{1} << 31) - 1 - static_cast<int64_t>(s.Below(100));
  if (const uint64_t of = s.Below(3); of != 0) c.budget.max = log_uniform(1e-3, 1);
  if (c.budget.max > 1 || s.Below(2)) c.budget.rms = log_uniform(1e-3, 1);
  return c;
}

// Where an octave that is evaluated in full or in tiles comes so near a simplex face that it may fall to
// either side.
inline bool OnFace(const std::vector<Octave>& octaves, NoiseKind kind, const FieldPlan& plan, int64_t t,
                   int64_t y, int64_t x) {
  if (kind == NoiseKind::kPerlin) return false;
  for (size_t i = 0; i < octaves.size(); ++i) {
    if (plan.octaves[i].kind == OctaveWayKind::kGrid) continue;
    const Octave& o = octaves[i];
    if (SimplexFaceDistance((o.origin[0] + o.step_px * x).Reduced().ToDouble(),
                            (o.origin[1] + o.step_px * y).Reduced().ToDouble(),
                            (o.origin[2] + o.step_frame * t).Reduced().ToDouble()) < 1e-6)
      return true;
  }
  return false;
}

// Calls check with the octaves as a sum of their kind.
template <class Check>
void WithOctaves(NoiseKind kind, const std::vector<Octave>& octaves, const Check& check) {
  if (kind == NoiseKind::kPerlin)
    check(PerlinOctaves(octaves));
  else
    check(SimplexOctaves(octaves, KernelOf(kind)));
}

}  // namespace shimmer::noise
