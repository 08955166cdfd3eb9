// How a sum of octaves is evaluated over an area of pixels: each octave in the cheapest way such that all
// together stay within an error budget.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "noise/noise_kind.h"
#include "noise/octaves.h"

namespace shimmer::noise {

enum class OctaveWayKind {
  kFull,     // at every pixel
  kDropped,  // not at all
  kGrid,     // at every spacing_px-th pixel, a cubic B-spline between; at every key_frames-th frame, a cubic
             // between
  kTiled     // once a period of an octave that is exactly periodic over pixels: the same bits as kFull
};

// Errors are against the octave itself, in the sum's unit.
struct OctaveWay {
  OctaveWayKind kind = OctaveWayKind::kFull;
  int spacing_px = 1;
  int key_frames = 1;
  int period_px = 0;     // of a tile
  double max_error = 0;  // of any pixel
  double rms_error = 0;  // over any frame of the area

  friend bool operator==(const OctaveWay&, const OctaveWay&) = default;
};

// What is promised of the sum: the sum of its octaves' largest errors; and the RMS, for which errors of
// octaves add like independent ones as far as the area has cells enough to tell. Beyond them come what the
// row kernels state: 5e-6 of the amplitude, and pixels within 1e-6 cell of a simplex face.
struct FieldPlan {
  std::vector<OctaveWay> octaves;
  double max_error = 0, rms_error = 0;

  friend bool operator==(const FieldPlan&, const FieldPlan&) = default;
};

// Both hold; in the sum's unit. 0: the same bits as full evaluation.
struct ErrorBudget {
  double max = std::numeric_limits<double>::infinity();
  double rms = std::numeric_limits<double>::infinity();
};

// A pure function of its arguments; of the octaves it takes steps and amplitudes alone. width, height: of the
// frame over which the RMS is promised, px; border_px: evaluated around it too; frames: how many are
// evaluated, as far as is known. Throws std::invalid_argument.
FieldPlan PlanOctaves(std::span<const Octave> octaves, NoiseKind kind, int width, int height, int frames,
                      ErrorBudget budget, int border_px = 0);

// The smallest number of pixels, a multiple of 64 and at most 1024, after which the octave repeats along an
// axis: Perlin noise; simplex noise after three times as many, and shifted by that number at each next row of
// tiles, for it repeats by (256, -256) and (768, 0) cells.
std::optional<int> PeriodPx(Fixed step_px);

}  // namespace shimmer::noise
