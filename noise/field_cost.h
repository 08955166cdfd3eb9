// What the ways to evaluate an octave cost, in cycles a frame: a model fitted to tests/bench/bench_fields,
// good enough to choose by. Plans, and with them pixels, depend on it: change it, and the engine number
// grows.
#pragma once

#include "noise/noise_kind.h"

namespace shimmer::noise {

class FieldCost {
 public:
  FieldCost(NoiseKind kind, int width_px, int height_px, int frames);

  double Full() const;
  double Tiled(int period_px) const;
  double OnGrid(int spacing_px, int key_frames) const;
  double Spline() const;  // once, if any octave lies on a grid

  // Grids at key frames are kept: those of up to 2^20 points.
  bool CanKeep(int spacing_px) const;

 private:
  double Rows(double rows, double points) const;
  double GridRows(int spacing_px) const;
  double GridPoints(int spacing_px) const;

  NoiseKind kind_;
  double width_, height_, frames_;
};

}  // namespace shimmer::noise
