#include "sim/drawn/canvas.h"

#include <limits>

#include "sim/drawn/waves.h"

namespace shimmer::sim {
namespace {

cv::Rect2d Around(cv::Point2d centre, double reach_px) {
  return {centre.x - reach_px, centre.y - reach_px, 2 * reach_px, 2 * reach_px};
}

}  // namespace

Rgb FromHue(double hue_turns, double saturation, double value) {
  Rgb colour;
  for (int c = 0; c < 3; ++c)
    colour[c] = float(value * (1 - saturation * (0.5 - 0.5 * CosTurns(hue_turns - c / 3.0))));
  return colour;
}

Canvas::Canvas(cv::Size crop, int halo_px)
    : crop_(crop),
      halo_px_(halo_px),
      pixels_(crop + cv::Size(2 * halo_px, 2 * halo_px), CV_32FC3, cv::Scalar::all(0)) {}

cv::Rect2d Canvas::WholeArea() const {
  return {-0.5 - halo_px_, -0.5 - halo_px_, double(pixels_.cols), double(pixels_.rows)};
}

void Canvas::Fill(const cv::Rect2d& area, const Rgb& colour) {
  Paint(area, [&](int, int) { return colour; });
}

void Canvas::Outline(const cv::Rect2d& area, double width_px, const Rgb& colour) {
  const double w = std::min({width_px, area.width / 2, area.height / 2});
  Fill({area.x, area.y, area.width, w}, colour);
  Fill({area.x, area.y + area.height - w, area.width, w}, colour);
  Fill({area.x, area.y + w, w, area.height - 2 * w}, colour);
  Fill({area.x + area.width - w, area.y + w, w, area.height - 2 * w}, colour);
}

void Canvas::Disc(cv::Point2d centre, double radius_px, const Rgb& colour) {
  Blend(Around(centre, radius_px + 1), colour,
        [&](int x, int y) { return EdgeCoverage(radius_px - Distance(x, y, centre)); });
}

void Canvas::Ring(cv::Point2d centre, double radius_px, double width_px, const Rgb& colour) {
  const double inner = radius_px - width_px / 2, outer = radius_px + width_px / 2;
  Blend(Around(centre, outer + 1), colour, [&](int x, int y) {
    const double r = Distance(x, y, centre);
    return EdgeCoverage(outer - r) - EdgeCoverage(inner - r);
  });
}

void Canvas::Polygon(std::span<const cv::Point2d> corners, const Rgb& colour) {
  cv::Point2d low = corners[0], high = corners[0];
  for (const cv::Point2d& p : corners) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  Blend({low - cv::Point2d(1, 1), high + cv::Point2d(1, 1)}, colour, [&](int x, int y) {
    double inside_px = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < corners.size(); ++i) {
      const cv::Point2d a = corners[i], edge = corners[(i + 1) % corners.size()] - a;
      const double length = std::sqrt(edge.dot(edge));
      inside_px = std::min(inside_px, edge.cross(cv::Point2d(x, y) - a) / length);
    }
    return EdgeCoverage(inside_px);
  });
}

void Canvas::Write(const std::string& text, Face face, double capital_px, cv::Point2d baseline,
                   const Rgb& colour) {
  Lettering letters = DrawLetters(text, face, capital_px, baseline);
  letters.corner += cv::Point(halo_px_, halo_px_);
  Stamp<float>(pixels_, letters, colour);
}

void Canvas::WriteCentred(const std::string& text, Face face, double capital_px, cv::Point2d centre,
                          const Rgb& colour) {
  Write(text, face, capital_px, centre + cv::Point2d(-TextWidth(text, face, capital_px) / 2, capital_px / 2),
        colour);
}

}  // namespace shimmer::sim
