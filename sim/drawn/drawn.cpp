#include "sim/drawn/drawn.h"

#include <sstream>
#include <stdexcept>

#include "sim/drawn/scenes.h"

namespace shimmer::sim {

DrawnScene DrawnSceneNamed(std::string_view name) {
  for (size_t i = 0; i < kDrawnSceneNames.size(); ++i)
    if (name == kDrawnSceneNames[i]) return DrawnScene(i);
  std::ostringstream text;
  text << "drawn scene \"" << name << "\", must be one of";
  for (const char* known : kDrawnSceneNames) text << " " << known;
  throw std::invalid_argument(text.str());
}

cv::Mat DrawScene(DrawnScene scene, cv::Size size, int halo_px, double scale, uint64_t variation) {
  if (size.width < 1 || size.height < 1)
    throw std::invalid_argument("size of a drawn scene = " + std::to_string(size.width) + " x " +
                                std::to_string(size.height) + ", must be at least 1 x 1");
  if (halo_px < 0) throw std::invalid_argument("halo_px = " + std::to_string(halo_px) + ", must be >= 0");
  if (!(scale >= 0.001 && scale <= 1000))
    throw std::invalid_argument("scale of a drawn scene = " + std::to_string(scale) +
                                ", must be in [0.001, 1000]");

  Canvas canvas(size, halo_px);
  switch (scene) {
    case DrawnScene::kChart:
      DrawChart(canvas, scale, variation);
      break;
    case DrawnScene::kBricks:
      DrawBricks(canvas, scale, variation);
      break;
    case DrawnScene::kText:
      DrawText(canvas, scale, variation);
      break;
    case DrawnScene::kStar:
      DrawStar(canvas, scale, variation);
      break;
    case DrawnScene::kStripes:
      DrawStripes(canvas, scale, variation);
      break;
  }
  return canvas.pixels();
}

}  // namespace shimmer::sim
