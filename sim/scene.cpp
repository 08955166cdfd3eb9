#include "sim/scene.h"

#include <algorithm>

namespace shimmer::sim {

void TiltParams::Validate() const {
  RangeCheck check("tilt");
  Fields(*this, check);
}

const noise::SimplexKernel& TiltParams::Kernel() const {
  return kernel == noise::kSimplexKernel05.radius2 ? noise::kSimplexKernel05 : noise::kSimplexKernel06;
}

double TiltParams::BoundPx() const { return strength_px * std::max(1.0, Kernel().bound); }

void BlurParams::Validate() const {
  RangeCheck check("blur");
  Fields(*this, check);
  if (min_sigma_px > max_sigma_px)
    throw std::invalid_argument(
        OutOfRange("blur.min_sigma_px", min_sigma_px,
                   Field{.name = "", .unit = "px", .low = 0, .high = max_sigma_px, .help = ""}));
}

void Accuracy::Validate() const {
  RangeCheck check("accuracy");
  Fields(*this, check);
}

void Scene::Validate() const {
  tilt.Validate();
  blur.Validate();
}

}  // namespace shimmer::sim
