// Panels of stripes: upright, level and slanted, sines and square waves, from a period near the finest that
// the pixel grid carries to the broadest that a panel shows.
#include <cmath>
#include <cstdio>
#include <iterator>

#include "noise/portable_math.h"
#include "sim/drawn/drawn.h"
#include "sim/drawn/scenes.h"
#include "sim/drawn/waves.h"

namespace shimmer::sim {
namespace {

constexpr int kAcross = 3;                      // panels along the crop's shorter side
constexpr int kMostPanels = 15, kLeastPx = 12;  // along the longer one, and a panel's least width
constexpr double kFinestPx = 4;                 // period at scale 1
constexpr double kWavesInBroadest = 2.5;
constexpr double kDirectionTurns[] = {0, 0.25, 20 / 360.0, 0, 0.25, -35 / 360.0};

int PanelsAlong(int side_px, int shorter_px) {
  const int square_ones = int(std::min<int64_t>(int64_t{kAcross} * side_px / shorter_px, kMostPanels));
  return std::max(1, std::min(square_ones, side_px / kLeastPx));
}

int GapPx(cv::Size size) { return std::min(size.width, size.height) / 120 * 2; }

// Where panel number i of n along a side begins, its half of the gap aside, and where the one before ends.
struct Span {
  int begin, end;
};
Span PanelSpan(int i, int n, int side_px, int gap_px) {
  const int begin = int(int64_t{side_px} * i / n), end = int(int64_t{side_px} * (i + 1) / n);
  return {i > 0 ? begin + gap_px / 2 : begin, i + 1 < n ? end - gap_px / 2 : end};
}

// The panel, gone on through the halo where it lies at the crop's edge.
cv::Rect2d WithHalo(const cv::Rect& area, cv::Size crop, const cv::Rect2d& whole) {
  const double x0 = area.x > 0 ? area.x - 0.5 : whole.x, y0 = area.y > 0 ? area.y - 0.5 : whole.y;
  const double x1 = area.br().x < crop.width ? area.br().x - 0.5 : whole.br().x;
  const double y1 = area.br().y < crop.height ? area.br().y - 0.5 : whole.br().y;
  return {x0, y0, x1 - x0, y1 - y0};
}

void Label(Canvas& canvas, const StripePanel& panel) {
  const double capital_px = std::min(panel.area.width, panel.area.height) / 20.0, pad_px = 0.8 * capital_px;
  if (capital_px < 5) return;
  char text[32];
  std::snprintf(text, sizeof text, "%.1f px", panel.period_px);
  const double width_px = TextWidth(text, Face::kSans, capital_px);
  const cv::Rect2d chip(panel.area.x + pad_px, panel.area.br().y - 2 * pad_px - 2 * capital_px,
                        width_px + 2 * pad_px, 2 * capital_px + pad_px);
  canvas.Fill(chip, Grey(0.93));
  canvas.WriteCentred(text, Face::kSans, capital_px, Centre(chip), Grey(0.1));
}

}  // namespace

std::vector<StripePanel> StripePanels(cv::Size size, double scale) {
  const int shorter = std::min(size.width, size.height), gap_px = GapPx(size);
  const int columns = PanelsAlong(size.width, shorter), rows = PanelsAlong(size.height, shorter);
  const double broadest_px = std::max(kFinestPx, shorter / (kAcross * kWavesInBroadest));
  std::vector<StripePanel> panels;
  for (int row = 0; row < rows; ++row) {
    const Span down = PanelSpan(row, rows, size.height, gap_px);
    for (int column = 0; column < columns; ++column) {
      const Span across = PanelSpan(column, columns, size.width, gap_px);
      const int index = row * columns + column, last = rows * columns - 1;
      const double rise = last > 0 ? double(index) / last : 0;
      const double turns = kDirectionTurns[(column + row) % std::size(kDirectionTurns)];
      panels.push_back(
          {.area = {across.begin, down.begin, across.end - across.begin, down.end - down.begin},
           .period_px = scale * kFinestPx * noise::Exp(rise * noise::Log(broadest_px / kFinestPx)),
           .direction = {CosTurns(turns), CosTurns(turns - 0.25)},
           .square = (row + column) % 2 == 1});
    }
  }
  return panels;
}

void DrawStripes(Canvas& canvas, double scale, uint64_t variation) {
  canvas.Fill(canvas.WholeArea(), Grey(0.5));
  uint64_t index = 0;
  for (const StripePanel& panel : StripePanels(canvas.crop(), scale)) {
    // Complementary tints of the same strength: the wave is one of lightness.
    const double hue = Detail(variation, "stripes.hue", index),
                 tint = 0.5 * Detail(variation, "stripes.tint", index);
    const Rgb light = FromHue(hue, 0.3 * tint, 0.93), dark = FromHue(hue + 0.5, tint, 0.1);
    const double start = Detail(variation, "stripes.start", index),
                 contrast = ContrastOfPeriod(panel.period_px);
    const cv::Point2d step = panel.direction / panel.period_px;  // turns per px
    canvas.Paint(WithHalo(panel.area, canvas.crop(), canvas.WholeArea()), [&](int x, int y) {
      const double turns = start + x * step.x + y * step.y;
      const double wave = panel.square ? 2 * SquareCoverage(turns, 1 / panel.period_px) - 1 : CosTurns(turns);
      return Mix(dark, light, 0.5 + 0.5 * contrast * wave);
    });
    Label(canvas, panel);
    ++index;
  }
}

}  // namespace shimmer::sim
