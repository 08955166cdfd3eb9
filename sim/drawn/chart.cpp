// A resolution chart: a grid of panels around a zone plate, in a frame with arrows at the middle of its
// sides, on a squared ground that goes on beyond it.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "sim/drawn/chart_panels.h"
#include "sim/drawn/scenes.h"
#include "sim/drawn/waves.h"

namespace shimmer::sim {
namespace {

constexpr double kLeastTilePx = 16;

// The first eight surround the zone plate on a small chart.
constexpr ChartPanel kPanels[] = {BarGroups, Sweep,       Checkers, GreySteps, ColourPatches, UprightWedge,
                                  Dots,      SlantedEdge, Letters,  Rings,     LevelWedge,    Wheel};

// Tiles of a side: how many, how many of them the centre piece takes, and where they lie.
struct Tiling {
  int count, first_of_centre, centre_count;
  double begin_px, tile_px;

  static Tiling Of(int side_px, double margin_px, double wish_px) {
    const double room_px = side_px - 2 * margin_px;
    const int count = std::max(1, int(std::lround(room_px / wish_px)));
    const int centre = count < 3 ? count : count % 2 ? (count < 5 ? 1 : 3) : 2;
    return {count, (count - centre) / 2, centre, margin_px - 0.5, room_px / count};
  }
  bool InCentre(int i) const { return i >= first_of_centre && i < first_of_centre + centre_count; }
  // On whole pixels, so that bars one pixel wide are.
  double Edge(int i) const { return std::round(begin_px + i * tile_px + 0.5) - 0.5; }
};

// The largest square of whole pixels within an area, `pad_px` from its edges.
cv::Rect2d SquareIn(const cv::Rect2d& area, double pad_px) {
  const double side = std::floor(std::min(area.width, area.height) - 2 * pad_px);
  return {area.x + std::floor((area.width - side) / 2), area.y + std::floor((area.height - side) / 2), side,
          side};
}

void Ground(Canvas& canvas, const Tiling& across, const Tiling& down, double line_px, const Rgb& ground,
            const Rgb& line) {
  const auto on_line = [&](double at, const Tiling& tiling) {
    const double step_px = tiling.tile_px / 2, cell = (at - tiling.begin_px) / step_px;
    return EdgeCoverage(line_px / 2 - std::abs(cell - std::floor(cell + 0.5)) * step_px);
  };
  canvas.Fill(canvas.WholeArea(), ground);
  canvas.Blend(canvas.WholeArea(), line,
               [&](int x, int y) { return std::max(on_line(x, across), on_line(y, down)); });
}

// Arrows that touch the crop's edge from inside, at the middle of each side.
void Arrows(Canvas& canvas, double size_px, const Rgb& colour) {
  const cv::Rect2d crop = canvas.CropArea();
  const cv::Point2d middle = Centre(crop);
  const double s = size_px;
  const cv::Point2d up[] = {{middle.x, crop.y}, {middle.x + s, crop.y + s}, {middle.x - s, crop.y + s}};
  const cv::Point2d down[] = {
      {middle.x, crop.br().y}, {middle.x - s, crop.br().y - s}, {middle.x + s, crop.br().y - s}};
  const cv::Point2d left[] = {{crop.x, middle.y}, {crop.x + s, middle.y - s}, {crop.x + s, middle.y + s}};
  const cv::Point2d right[] = {
      {crop.br().x, middle.y}, {crop.br().x - s, middle.y + s}, {crop.br().x - s, middle.y - s}};
  for (const auto& arrow : {up, down, left, right}) canvas.Polygon({arrow, 3}, colour);
}

}  // namespace

void DrawChart(Canvas& canvas, double scale, uint64_t variation) {
  const cv::Size size = canvas.crop();
  const int shorter = std::min(size.width, size.height);
  const double margin_px = std::floor(0.03 * shorter);
  const double wish_px = std::max(kLeastTilePx, scale * (shorter < 128 ? shorter / 3.0 : shorter / 5.0));
  const Tiling across = Tiling::Of(size.width, margin_px, wish_px),
               down = Tiling::Of(size.height, margin_px, wish_px);

  const double hue = Detail(variation, "chart.hue");
  const ChartLook look{.paper = FromHue(hue, 0.05, 0.93),
                       .ink = FromHue(hue + 0.5, 0.3, 0.07),
                       .accent = FromHue(hue + 0.9, 0.85, 0.8),
                       .hue_turns = Detail(variation, "chart.patches"),
                       .scale = scale,
                       .slant_turns = (4 + 4 * Detail(variation, "chart.slant")) / 360};
  const double tile_px = std::min(across.tile_px, down.tile_px),
               line_px = std::max(1.0, std::round(tile_px / 70));
  Ground(canvas, across, down, line_px, FromHue(hue + 0.6, 0.1, 0.5), FromHue(hue, 0.05, 0.72));
  canvas.Outline({margin_px - 0.5 - line_px, margin_px - 0.5 - line_px,
                  size.width - 2 * (margin_px - line_px), size.height - 2 * (margin_px - line_px)},
                 2 * line_px, look.ink);
  Arrows(canvas, margin_px, look.ink);

  const double gap_px = std::max(1.0, std::round(tile_px / 24)),
               pad_px = std::max(1.0, std::round(tile_px / 16));
  const auto card = [&](int column, int row, int columns, int rows) {
    const double x0 = across.Edge(column) + gap_px, y0 = down.Edge(row) + gap_px;
    const cv::Rect2d area(x0, y0, across.Edge(column + columns) - gap_px - x0,
                          down.Edge(row + rows) - gap_px - y0);
    canvas.Fill(area, look.paper);
    return SquareIn(area, pad_px);
  };
  ZonePlate(canvas,
            card(across.first_of_centre, down.first_of_centre, across.centre_count, down.centre_count), look);
  size_t next = 0;
  for (int row = 0; row < down.count; ++row)
    for (int column = 0; column < across.count; ++column)
      if (!across.InCentre(column) || !down.InCentre(row))
        kPanels[next++ % std::size(kPanels)](canvas, card(column, row, 1, 1), look);
}

}  // namespace shimmer::sim
