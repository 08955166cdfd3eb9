#include "sim/drawn/chart_panels.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "sim/drawn/waves.h"

namespace shimmer::sim {
namespace {

// Three upright and three level bars, `bar_px` wide and five times as long, side by side from `corner`.
void BarTriples(Canvas& canvas, cv::Point2d corner, int bar_px, const Rgb& ink) {
  const double length_px = 5.0 * bar_px;
  for (int i = 0; i < 3; ++i) {
    canvas.Fill({corner.x + 2 * i * bar_px, corner.y, double(bar_px), length_px}, ink);
    canvas.Fill({corner.x + 7 * bar_px, corner.y + 2 * i * bar_px, length_px, double(bar_px)}, ink);
  }
}

}  // namespace

void BarGroups(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  constexpr int kBarsPx[] = {24, 16, 12, 8, 6, 4, 3, 2, 1};
  std::vector<int> bars_px;  // from the finest up, as many as fit
  double height_px = 0;
  for (int i = int(std::size(kBarsPx)) - 1; i >= 0; --i) {
    const int bar_px = std::max(1, int(std::lround(kBarsPx[i] * look.scale)));
    const double gap_px = std::max(2, bar_px);
    if (height_px + 5 * bar_px + gap_px > area.height || 12 * bar_px > area.width) break;
    if (!bars_px.empty() && bars_px.back() == bar_px) continue;
    height_px += 5 * bar_px + gap_px;
    bars_px.push_back(bar_px);
  }
  double y = area.y + std::floor((area.height - height_px) / 2) + 1;
  for (auto bar_px = bars_px.rbegin(); bar_px != bars_px.rend(); ++bar_px) {
    BarTriples(canvas, {area.x + std::floor((area.width - 12 * *bar_px) / 2), y}, *bar_px, look.ink);
    y += 5 * *bar_px + std::max(2, *bar_px);
  }
}

void Checkers(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  // Whole cells of every size, where they fit.
  const int widest_px = int(area.width * 0.49), unit_px = std::max(1, int(16 * look.scale));
  const int field_px = widest_px < 2 * unit_px ? widest_px : widest_px / unit_px * unit_px,
            last_px = int(area.width) - field_px;
  for (int i = 0; i < 4; ++i) {
    const int cell_px = int(std::clamp((8 >> i) * look.scale, 1.0, std::max(1.0, field_px / 2.0)));
    const int cells = field_px / cell_px;
    const double x0 = area.x + (i % 2 ? last_px : 0), y0 = area.y + (i / 2 ? last_px : 0);
    const double spare_px = std::floor((field_px - cells * cell_px) / 2.0);
    const cv::Rect2d field(x0 + spare_px, y0 + spare_px, cells * cell_px, cells * cell_px);
    canvas.Blend(field, look.ink, [&](int x, int y) {
      return (int(x - field.x) / cell_px + int(y - field.y) / cell_px) % 2 == 0 ? 1.0 : 0.0;
    });
  }
}

void SlantedEdge(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  const cv::Point2d centre = Centre(area);
  const double half_px = 0.41 * area.width;
  const cv::Point2d u = half_px * cv::Point2d(CosTurns(look.slant_turns), CosTurns(look.slant_turns - 0.25));
  const cv::Point2d v(-u.y, u.x);
  const cv::Point2d corners[] = {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
  canvas.Polygon(corners, Mix(look.ink, look.paper, 0.15));
}

void GreySteps(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  constexpr int kSteps = 8;
  for (int i = 0; i < kSteps; ++i) {
    const double x0 = std::round(area.width * i / kSteps), x1 = std::round(area.width * (i + 1) / kSteps);
    const double half_px = std::round(area.height / 2), share = i / (kSteps - 1.0);
    canvas.Fill({area.x + x0, area.y, x1 - x0, half_px}, Mix(look.ink, look.paper, share));
    canvas.Fill({area.x + x0, area.y + half_px, x1 - x0, area.height - half_px},
                Mix(look.paper, look.ink, share));
  }
  canvas.Outline(area, 1, look.ink);
}

void ColourPatches(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  struct Row {
    double saturation, value;
  };
  constexpr Row kRows[] = {{0.85, 0.92}, {0.45, 0.9}, {0.8, 0.62}, {0.6, 0.35}};
  constexpr int kAcross = 4;
  const double gap_px = std::round(area.width / 40);
  for (int row = 0; row < kAcross; ++row) {
    for (int column = 0; column < kAcross; ++column) {
      const double x0 = std::round(area.width * column / kAcross),
                   x1 = std::round(area.width * (column + 1) / kAcross);
      const double y0 = std::round(area.height * row / kAcross),
                   y1 = std::round(area.height * (row + 1) / kAcross);
      const double hue = look.hue_turns + (column + 0.5 * (row % 2)) / kAcross;
      canvas.Fill({area.x + x0, area.y + y0, x1 - x0 - gap_px, y1 - y0 - gap_px},
                  FromHue(hue, kRows[row].saturation, kRows[row].value));
    }
  }
}

void Dots(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  canvas.Fill(area, look.ink);
  constexpr double kRadiiPx[] = {4, 2.5, 1.5, 1, 0.5};
  const int across = int(std::clamp(area.width / (8 * look.scale), 2.0, 5.0));
  const double cell_px = area.width / across;
  for (int row = 0; row < across; ++row) {
    const double radius_px =
        std::min(kRadiiPx[row * int(std::size(kRadiiPx)) / across] * look.scale, 0.35 * cell_px);
    for (int column = 0; column < across; ++column) {
      // On pixel centres, so that the points of a row are alike.
      const cv::Point2d at(std::round(area.x + (column + 0.5) * cell_px),
                           std::round(area.y + (row + 0.5) * cell_px));
      canvas.Disc(at, radius_px, look.paper);
    }
  }
}

void Letters(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  constexpr const char* kLines[] = {"R",         "H K",         "S O N",        "Z V D C",
                                    "K R H S O", "N C Z D V K", "O S R H N C D"};
  double y = area.y, capital_px = 0.28 * area.height;
  for (const char* line : kLines) {
    if (capital_px < 3.5 || y + capital_px > area.y + area.height) break;
    canvas.WriteCentred(line, Face::kSerifBold, capital_px, {Centre(area).x, y + capital_px / 2}, look.ink);
    y += 1.45 * capital_px;
    capital_px *= 0.67;
  }
}

void Wheel(Canvas& canvas, const cv::Rect2d& area, const ChartLook& look) {
  const cv::Point2d centre = Centre(area);
  const double radius_px = 0.49 * area.width, rim_px = std::max(1.0, 0.05 * area.width);
  canvas.Blend(area, look.ink, [&](int x, int y) {
    const double right = EdgeCoverage(x - centre.x), below = EdgeCoverage(y - centre.y);
    const double quarters = right * below + (1 - right) * (1 - below);
    return quarters * EdgeCoverage(radius_px - 2 * rim_px - Distance(x, y, centre));
  });
  canvas.Ring(centre, radius_px - rim_px / 2, rim_px, look.accent);
}

}  // namespace shimmer::sim
