// The chart's panels that are waves: converging lines, rings, sweeps and the zone plate.
#include <algorithm>
#include <cmath>

#include "sim/drawn/chart_panels.h"
#include "sim/drawn/waves.h"

namespace shimmer::sim {
namespace {

// Lines that converge along the area, up to nine: to the right if level, downwards if not.
void Wedge(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look, bool level) {
  const cv::Point2d centre = Centre(area);
  const double lines = std::clamp(2 * std::floor(area.width / 10) + 1, 3.0, 9.0);
  const double wide_px = 0.96 * area.width / lines, narrow_px = std::min(wide_px, 2 * look.scale);
  canvas.Blend(area, look.ink, [&](int x, int y) {
    const double along = (level ? x - area.x : y - area.y) / area.width;
    const double aside_px = level ? y - centre.y : x - centre.x;
    const double period_px = wide_px + (narrow_px - wide_px) * std::clamp(along, 0.0, 1.0);
    const double line = aside_px / period_px;
    if (std::abs(line) > lines / 2) return 0.0;
    const double contrast = ContrastOfPeriod(period_px);
    return 0.5 + contrast * (SquareCoverage(line + 0.25, 1 / period_px) - 0.5);
  });
}

}  // namespace

void UprightWedge(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  Wedge(canvas, area, look, false);
}
void LevelWedge(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  Wedge(canvas, area, look, true);
}

void Rings(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  constexpr double kRings = 6;
  const cv::Point2d centre = Centre(area);
  const double radius_px = area.width / 2, period_px = std::max(radius_px / kRings, 4.0);
  canvas.Blend(area, look.ink, [&](int x, int y) {
    const double r = Distance(x, y, centre);
    return SquareCoverage(r / period_px + 0.25, 1 / period_px) * EdgeCoverage(radius_px - r);
  });
}

void Sweep(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  // Frequency rises along the upper half and falls along the lower one.
  const double slow = 2.5 / area.width, fast = std::max(slow, 0.4 / std::max(1.0, look.scale));
  const double half_px = std::round(area.height / 2);
  canvas.Blend(area, look.ink, [&](int x, int y) {
    const double u = (y - area.y < half_px) ? x - area.x : area.x + area.width - x;
    const double frequency = slow + (fast - slow) * u / area.width, turns = (slow + frequency) / 2 * u;
    return 0.5 + 0.5 * ContrastOfPeriod(1 / frequency) * CosTurns(turns);
  });
}

void ZonePlate(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  const cv::Point2d centre = Centre(area);
  const double half_px = area.width / 2, radius_px = 0.9 * half_px,
               line_px = std::max(1.0, std::round(half_px / 110));
  // Frequency f r / R: far below Nyquist everywhere.
  const double finest = 0.25 / std::max(1.0, look.scale);
  canvas.Blend(area, look.ink, [&](int x, int y) {
    const double r = Distance(x, y, centre);
    return (0.5 - 0.5 * CosTurns(0.5 * finest * r * r / radius_px)) * EdgeCoverage(radius_px - r);
  });
  canvas.Ring(centre, radius_px, 2 * line_px, look.ink);
  // Crosshair: from the card's edges into the disc, and a cross in its middle.
  for (int side = 0; side < 4; ++side) {
    const cv::Point2d out[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const cv::Point2d along = out[side], across(std::abs(along.y), std::abs(along.x));
    const auto arm = [&](double from_px, double to_px, double width_px, const Rgb& colour) {
      const cv::Point2d a = centre + from_px * along - width_px / 2 * across,
                        b = centre + to_px * along + width_px / 2 * across;
      canvas.Fill({std::min(a.x, b.x), std::min(a.y, b.y), std::abs(b.x - a.x), std::abs(b.y - a.y)}, colour);
    };
    arm(0.82 * half_px, half_px, 2 * line_px, look.accent);
    arm(0, 0.06 * half_px, line_px, look.accent);
  }
}

}  // namespace shimmer::sim
