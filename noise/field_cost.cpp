#include "noise/field_cost.h"

#include <algorithm>
#include <cmath>

#include "noise/spline_rows.h"

namespace shimmer::noise {
namespace {

constexpr double kSimplexPoint = 3.0, kPerlinPoint = 1.9;
constexpr double kRowStart = 120, kVectorPoints = 16;
constexpr double kFilterPoint = 1, kRefinePoint = 0.5;  // of a coefficient
constexpr double kMixPoint = 1, kMixFarPoint = 3;       // of four grids in the cache, or beyond it
constexpr double kAddPixel = 0.3, kSplinePixel = 0.6;
constexpr double kTilePixel = 0.1;  // a share: tiles are mostly added together, as one
constexpr double kCachePoints = 1 << 16;
constexpr double kMostKeptPoints = 1 << 20;
constexpr int kGridBorder = 4 + 2 * kSplineFilterReach;  // points around the area, both sides together

}  // namespace

FieldCost::FieldCost(NoiseKind kind, int width_px, int height_px, int frames)
    : kind_(kind), width_(width_px), height_(height_px), frames_(frames) {}

double FieldCost::Rows(double rows, double points) const {
  const double vectors = std::ceil(points / kVectorPoints) + 0.5;  // the first begins before the row, or not
  const double point = kind_ == NoiseKind::kPerlin ? kPerlinPoint : kSimplexPoint;
  return rows * (kRowStart + vectors * kVectorPoints * point);
}

double FieldCost::Full() const { return Rows(height_, width_); }

double FieldCost::Tiled(int period_px) const {
  const double tile_width = kind_ == NoiseKind::kPerlin ? period_px : 3 * period_px;
  return Rows(std::min<double>(period_px, height_), tile_width) + kTilePixel * width_ * height_;
}

double FieldCost::GridRows(int spacing_px) const {
  return spacing_px == 1 ? height_ : std::ceil(height_ / spacing_px) + kGridBorder;
}

double FieldCost::GridPoints(int spacing_px) const {
  return spacing_px == 1 ? width_ : std::ceil(width_ / spacing_px) + kGridBorder;
}

double FieldCost::OnGrid(int spacing_px, int key_frames) const {
  const double rows = GridRows(spacing_px), row_points = GridPoints(spacing_px), points = rows * row_points;
  double cycles = Rows(rows, row_points);
  if (spacing_px > 1) cycles += kFilterPoint * points;
  if (key_frames > 1) {
    const double keys = std::ceil(frames_ / key_frames) + 3;  // key frames that the frames are mixed from
    cycles *= keys / frames_;
    cycles += (points * 4 > kCachePoints ? kMixFarPoint : kMixPoint) * points;
  }
  return cycles + (spacing_px > 1 ? kRefinePoint * points : kAddPixel * points);
}

double FieldCost::Spline() const { return kSplinePixel * width_ * height_; }

bool FieldCost::CanKeep(int spacing_px) const {
  return GridRows(spacing_px) * GridPoints(spacing_px) <= kMostKeptPoints;
}

}  // namespace shimmer::noise
