// A brick wall in running bond, lit from the upper left: every brick has its own colour, grain and slightly
// worn edges.
#include "noise/lattice.h"
#include "noise/perlin_double.h"
#include "sim/drawn/scenes.h"
#include "sim/drawn/waves.h"

namespace shimmer::sim {
namespace {

// Of the wall, in px of the crop. A course is a row of bricks with the joint below it.
struct Wall {
  double course_px, brick_px, joint_px;
  double hue, saturation, value;
  noise::Permutation grain;

  double Noise(double x, double y, double waves_per_course, double layer) const {
    const double f = waves_per_course / course_px;
    return noise::PerlinDouble(grain, x * f, y * f, layer + 0.37);
  }
};

Wall BuildWall(cv::Size crop, double scale, uint64_t variation) {
  const int shorter = std::min(crop.width, crop.height);
  const double course_px = std::max(3.0, std::clamp(shorter / 14.0, 12.0, 40.0) * scale);
  // Clays from purple-brown over red to buff.
  const double warm = Detail(variation, "bricks.hue");
  noise::HashStream stream(noise::HashPath(variation, 0, "bricks.grain"));
  return {.course_px = course_px,
          .brick_px = 3 * course_px,
          .joint_px = std::max(0.5, 0.15 * course_px),
          .hue = 0.015 + 0.06 * warm,
          .saturation = 0.75 - 0.25 * Detail(variation, "bricks.saturation"),
          .value = 0.46 + 0.18 * warm,
          .grain = noise::ShuffledPermutation(stream)};
}

// Slow light over the wall: bright at the upper left of the crop, darker towards the lower right; stained in
// places.
double Light(const Wall& wall, cv::Size crop, int x, int y) {
  const double along = 0.5 * (x / double(crop.width) + y / double(crop.height));
  return 1.08 - 0.3 * std::clamp(along, 0.0, 1.0) + 0.12 * wall.Noise(x, y, 0.17, 3);
}

Rgb Shown(const Rgb& colour, double light) {
  Rgb shown;
  for (int c = 0; c < 3; ++c) shown[c] = float(std::clamp(colour[c] * light, 0.02, 0.98));
  return shown;
}

void PaintMortar(Canvas& canvas, const Wall& wall) {
  const Rgb mortar(0.86f, 0.84f, 0.79f);
  canvas.Paint(canvas.WholeArea(), [&](int x, int y) {
    const double grain = 0.10 * wall.Noise(x, y, 5, 0) + 0.06 * wall.Noise(x, y, 9, 1);
    return Shown(mortar, Light(wall, canvas.crop(), x, y) * (1 + grain));
  });
}

void PaintBrick(Canvas& canvas, const Wall& wall, uint64_t variation, int row, int column) {
  const uint64_t brick = uint64_t(uint32_t(row)) << 32 | uint32_t(column);
  const auto detail = [&](std::string_view what) { return Detail(variation, what, brick) - 0.5; };
  const double left = (column + (row % 2 ? 0.5 : 0.0)) * wall.brick_px, top = row * wall.course_px;
  const double half_w = (wall.brick_px - wall.joint_px) / 2, half_h = (wall.course_px - wall.joint_px) / 2;
  const cv::Point2d centre(left + wall.brick_px / 2, top + wall.course_px / 2);
  const double corner_px = 0.12 * wall.course_px, worn_px = 0.025 * wall.course_px,
               bevel_px = 0.1 * wall.course_px;

  const double burnt =
      Detail(variation, "bricks.burnt", brick) < 0.12 ? 0.62 : 1;  // some lay too near the fire
  const Rgb clay = FromHue(wall.hue + 0.03 * detail("bricks.own_hue"),
                           wall.saturation + 0.2 * detail("bricks.own_saturation"),
                           burnt * wall.value * (1 + 0.45 * detail("bricks.own_value")));
  const double layer = 10 + 200 * (detail("bricks.layer") + 0.5);

  // Distance to the brick's rounded outline, worn by noise; > 0 inside.
  const auto inside_px = [&](int x, int y) {
    const double qx = std::abs(x - centre.x) - half_w + corner_px,
                 qy = std::abs(y - centre.y) - half_h + corner_px;
    const double ax = std::max(qx, 0.0), ay = std::max(qy, 0.0);
    return corner_px - std::sqrt(ax * ax + ay * ay) - std::min(std::max(qx, qy), 0.0) +
           worn_px * wall.Noise(x, y, 2.5, layer);
  };
  const cv::Rect2d area(left, top, wall.brick_px + wall.joint_px, wall.course_px + wall.joint_px);
  // The joint is set back: the brick above and to the left of it throws a shadow into it.
  const int shadow_px = cvRound(0.6 * wall.joint_px);
  canvas.Blend(area, Rgb(0.2f, 0.17f, 0.16f),
               [&](int x, int y) { return 0.4 * EdgeCoverage(inside_px(x - shadow_px, y - shadow_px)); });
  canvas.Visit(area, [&](int x, int y, double share, Rgb& pixel) {
    const double inside = inside_px(x, y), cover = share * EdgeCoverage(inside);
    if (cover <= 0) return;
    const double pits = SmoothStep(0.35, 0.6, wall.Noise(x, y, 5.5, layer + 1));
    const double grain = 0.2 * wall.Noise(x, y, 0.9, layer) + 0.2 * wall.Noise(x, y, 8, layer) - 0.35 * pits;
    const bool beside =
        std::abs(x - centre.x) - half_w > std::abs(y - centre.y) - half_h;  // nearest side is upright
    const double bevel =
        ((beside ? x < centre.x : y < centre.y) ? 0.16 : -0.22) * (1 - SmoothStep(0, bevel_px, inside));
    pixel = Mix(pixel, Shown(clay, Light(wall, canvas.crop(), x, y) * (1 + grain + bevel)), cover);
  });
}

}  // namespace

void DrawBricks(Canvas& canvas, double scale, uint64_t variation) {
  const Wall wall = BuildWall(canvas.crop(), scale, variation);
  PaintMortar(canvas, wall);
  const cv::Rect2d whole = canvas.WholeArea();
  for (int row = cvFloor(whole.y / wall.course_px); row * wall.course_px < whole.br().y; ++row)
    for (int column = cvFloor(whole.x / wall.brick_px) - 1; column * wall.brick_px < whole.br().x; ++column)
      PaintBrick(canvas, wall, variation, row, column);
}

}  // namespace shimmer::sim
