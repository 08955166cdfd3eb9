// A Siemens star: spokes that narrow towards the centre, in a dial with a tick for each, with rings where a
// spoke and its gap are 4, 8, 16, ... px wide together (times the scale).
#include <numbers>

#include "sim/drawn/drawn.h"
#include "sim/drawn/scenes.h"
#include "sim/drawn/waves.h"

namespace shimmer::sim {
namespace {

constexpr double kDial = 1.07;  // outer radius of the dial, in radii of the star

struct Star {
  cv::Point2d centre;
  double radius_px;
  double turned;  // turns
  Rgb light, dark;

  // Share of light in pixel (x, y), with the contrast around 1/2 that the grid and the place allow.
  double Light(double dx, double dy, double r) const {
    const double period_px = 2 * std::numbers::pi * r / kStarSpokes;
    const double contrast = ContrastOfPeriod(period_px);
    if (contrast == 0) return 0.5;
    const double wave = SquareCoverage((AngleTurns(dx, dy) + turned) * kStarSpokes, 1 / period_px);
    return 0.5 + contrast * (wave - 0.5);
  }
};

}  // namespace

double StarRadius(cv::Size size, double scale) { return 0.45 * std::min(size.width, size.height) * scale; }

void DrawStar(Canvas& canvas, double scale, uint64_t variation) {
  const cv::Size size = canvas.crop();
  const double tint = Detail(variation, "star.tint");
  const Star star{.centre = Centre(canvas.CropArea()),
                  .radius_px = StarRadius(size, scale),
                  .turned = Detail(variation, "star.turned") / kStarSpokes,
                  .light = FromHue(tint, 0.06, 0.95),
                  .dark = FromHue(tint + 0.5, 0.3, 0.06)};
  const Rgb grey = Mix(star.light, star.dark, 0.5);
  const Rgb pale_light = Mix(grey, star.light, 0.55), pale_dark = Mix(grey, star.dark, 0.25);

  canvas.Paint(canvas.WholeArea(), [&](int x, int y) {
    const double dx = x - star.centre.x, dy = y - star.centre.y, r = Distance(x, y, star.centre);
    const double light = star.Light(dx, dy, r);
    const Rgb inner = Mix(star.dark, star.light, light), outer = Mix(pale_dark, pale_light, light);
    return Mix(outer, inner, EdgeCoverage(star.radius_px - r));
  });

  // Rings, as far as they lie well inside.
  const Rgb accent = FromHue(tint + 0.9, 0.85, 0.85);
  const double line_px = std::clamp(star.radius_px / 180, 1.0, 3.0);
  for (double period_px = 4 * scale;; period_px *= 2) {
    const double r = period_px * kStarSpokes / (2 * std::numbers::pi);
    if (r > 0.93 * star.radius_px) break;
    canvas.Ring(star.centre, r, line_px, accent);
  }

  // The dial: a tick for each spoke, a long one each quarter.
  const double r0 = star.radius_px, r1 = kDial * r0;
  const cv::Rect2d around(star.centre.x - r1 - 1, star.centre.y - r1 - 1, 2 * r1 + 2, 2 * r1 + 2);
  canvas.Ring(star.centre, (r0 + r1) / 2, r1 - r0, star.light);
  canvas.Blend(around, star.dark, [&](int x, int y) {
    const double dx = x - star.centre.x, dy = y - star.centre.y, r = Distance(x, y, star.centre);
    if (r < r0 - 1 || r > r1 + 1) return 0.0;
    const double spoke = (AngleTurns(dx, dy) + star.turned) * kStarSpokes, nearest = std::floor(spoke + 0.5);
    const bool quarter = std::fmod(nearest + kStarSpokes, kStarSpokes / 4) == 0;
    const double aside_px = std::abs(spoke - nearest) * 2 * std::numbers::pi * r / kStarSpokes;
    return EdgeCoverage(line_px / 2 - aside_px) * EdgeCoverage(r - r0) *
           EdgeCoverage((quarter ? r1 : (r0 + r1) / 2) - r);
  });
  canvas.Ring(star.centre, r0, line_px, star.dark);
  canvas.Ring(star.centre, r1, line_px, star.dark);
}

}  // namespace shimmer::sim
