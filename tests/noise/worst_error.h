// The error of interpolating one octave, worst over all tables: at a given place the error is a sum over the
// lattice's corners of gradient . v, v a vector that the place alone decides, so that the largest error over
// every choice of gradients is the sum of the largest gradient . v; its mean square follows as well.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "noise/noise_kind.h"

namespace shimmer::noise {

// What an error is made of: points with their weights; the true value has weight -1.
class ErrorAtPlace {
 public:
  explicit ErrorAtPlace(NoiseKind kind) : kind_(kind) {}

  void Add(double x, double y, double z, double weight) {
    if (kind_ == NoiseKind::kPerlin)
      AddPerlin(x, y, z, weight);
    else
      AddSimplex(x, y, z, weight);
  }

  double Worst() const {  // over gradients: +-1 along two of three axes
    double sum = 0;
    for (const Corner& corner : corners_) {
      const double x = std::abs(corner.v[0]), y = std::abs(corner.v[1]), z = std::abs(corner.v[2]);
      sum += x + y + z - std::min({x, y, z});
    }
    return sum;
  }

  double MeanSquare() const {  // over gradients: two thirds of |v|^2
    double sum = 0;
    for (const Corner& corner : corners_)
      for (const double v : corner.v) sum += v * v * 2 / 3;
    return sum;
  }

 private:
  struct Corner {
    std::array<int, 3> cell;
    std::array<double, 3> v;
  };

  void AddTo(std::array<int, 3> cell, double x, double y, double z, double weight) {
    auto corner = std::ranges::find(corners_, cell, &Corner::cell);
    if (corner == corners_.end()) corner = corners_.insert(corners_.end(), Corner{cell, {0, 0, 0}});
    corner->v[0] += weight * x, corner->v[1] += weight * y, corner->v[2] += weight * z;
  }

  void AddPerlin(double x, double y, double z, double weight) {
    const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const double at[3] = {x, y, z};
    int cell[3];
    double rest[3];
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = static_cast<int>(std::floor(at[axis]));
      rest[axis] = at[axis] - cell[axis];
    }
    for (int corner = 0; corner < 8; ++corner) {
      const int up[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
      double share = weight;
      for (int axis = 0; axis < 3; ++axis) share *= up[axis] ? fade(rest[axis]) : 1 - fade(rest[axis]);
      AddTo({cell[0] + up[0], cell[1] + up[1], cell[2] + up[2]}, rest[0] - up[0], rest[1] - up[1],
            rest[2] - up[2], share);
    }
  }

  void AddSimplex(double x, double y, double z, double weight) {
    const SimplexKernel& kernel = KernelOf(kind_);
    const double skew = (x + y + z) / 3, u = x + skew, v = y + skew, w = z + skew;
    const int cell[3] = {static_cast<int>(std::floor(u)), static_cast<int>(std::floor(v)),
                         static_cast<int>(std::floor(w))};
    // From corner 0 to corner 3, each axis in turn, the largest fraction first
    const double fraction[3] = {u - cell[0], v - cell[1], w - cell[2]};
    int order[3] = {0, 1, 2};
    std::ranges::stable_sort(order, [&](int a, int b) { return fraction[a] > fraction[b]; });
    std::array<int, 3> corner = {cell[0], cell[1], cell[2]};
    for (int k = 0; k < 4; ++k) {
      if (k > 0) ++corner[order[k - 1]];
      const double unskew = (corner[0] + corner[1] + corner[2]) / 6.0;
      const double px = x - (corner[0] - unskew), py = y - (corner[1] - unskew),
                   pz = z - (corner[2] - unskew);
      const double reach = std::max(0.0, kernel.radius2 - px * px - py * py - pz * pz);
      AddTo(corner, px, py, pz, weight * kernel.scale * reach * reach * reach * reach);
    }
  }

  NoiseKind kind_;
  std::vector<Corner> corners_;
};

using Point5 = std::array<double, 5>;  // x, y, z in cells, and where between the grid's points, in [0, 1)

// Cubic B-splines over filtered points (noise/spline_rows.h), cells_per_point cells apart along x and y.
inline ErrorAtPlace GridError(NoiseKind kind, double cells_per_point, const Point5& at) {
  constexpr double kFilter[7] = {-1.0 / 216,  12.0 / 216, -75.0 / 216, 344.0 / 216,
                                 -75.0 / 216, 12.0 / 216, -1.0 / 216};
  double weights[2][10] = {};
  for (int axis = 0; axis < 2; ++axis) {
    const double t = at[3 + axis], t2 = t * t, t3 = t2 * t;
    const double spline[4] = {(1 - 3 * t + 3 * t2 - t3) / 6, (4 - 6 * t2 + 3 * t3) / 6,
                              (1 + 3 * t + 3 * t2 - 3 * t3) / 6, t3 / 6};
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 7; ++k) weights[axis][i + k] += spline[i] * kFilter[k];
  }
  ErrorAtPlace error(kind);
  const double h = cells_per_point;
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 10; ++i)
      error.Add(at[0] + (i - 4) * h, at[1] + (j - 4) * h, at[2], weights[0][i] * weights[1][j]);
  error.Add(at[0] + at[3] * h, at[1] + at[4] * h, at[2], -1);
  return error;
}

// A cubic through four frames, cells_per_key cells apart along z.
inline ErrorAtPlace KeyError(NoiseKind kind, double cells_per_key, const Point5& at) {
  const double t = at[3];
  const double weights[4] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                             -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
  ErrorAtPlace error(kind);
  for (int k = 0; k < 4; ++k) error.Add(at[0], at[1], at[2] + (k - 1) * cells_per_key, weights[k]);
  error.Add(at[0], at[1], at[2] + t * cells_per_key, -1);
  return error;
}

struct FoundError {
  double max = 0, rms = 0;
};

// error(place) -> ErrorAtPlace: the mean over random places, and the worst of them improved by climbing.
template <class Error>
FoundError SearchError(const Error& error, int places, int climbs, int steps, uint32_t seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> cells(0, 6), unit(0, 1);
  std::normal_distribution<double> normal;
  struct Start {
    double worst;
    Point5 at;
  };
  std::vector<Start> starts;
  double squares = 0;
  for (int i = 0; i < places; ++i) {
    const Point5 at = {cells(random), cells(random), cells(random), unit(random), unit(random)};
    const ErrorAtPlace e = error(at);
    squares += e.MeanSquare();
    starts.push_back({e.Worst(), at});
  }
  climbs = std::min<int>(climbs, places);
  std::partial_sort(starts.begin(), starts.begin() + climbs, starts.end(),
                    [](const Start& a, const Start& b) { return a.worst > b.worst; });
  FoundError found{0, std::sqrt(squares / places)};
  for (int c = 0; c < climbs; ++c) {
    Start best = starts[c];
    double reach = 0.1;
    for (int s = 0; s < steps; ++s) {
      Point5 at = best.at;
      for (double& v : at) v += reach * normal(random) * (unit(random) < 0.5);
      at[3] = std::clamp(at[3], 0.0, 1.0), at[4] = std::clamp(at[4], 0.0, 1.0);
      const double worst = error(at).Worst();
      if (worst > best.worst)
        best = {worst, at}, reach *= 1.5;
      else
        reach = std::max(reach * 0.95, 1e-5);
    }
    found.max = std::max(found.max, best.worst);
  }
  return found;
}

}  // namespace shimmer::noise
