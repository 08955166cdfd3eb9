#include "sim/field_plan.h"

#include "sim/sigma_map.h"
#include "sim/tilt_field.h"

namespace shimmer::sim {
namespace {

noise::NoiseKind KindOf(const TiltParams& tilt) {
  return tilt.kernel == 0.5 ? noise::NoiseKind::kSimplex05 : noise::NoiseKind::kSimplex06;
}

}  // namespace

// Steps and amplitudes are the same whatever the lattice, the clip or the axis: any octaves serve.

noise::FieldPlan PlanTiltField(const TiltParams& tilt, cv::Size size, int frames, noise::ErrorBudget budget,
                               int border_px) {
  return noise::PlanOctaves(noise::ClassicOctaves(SumOf(tilt), {}), KindOf(tilt), size.width, size.height,
                            frames, budget, border_px);
}

noise::FieldPlan PlanBlurNoise(const BlurParams& blur, cv::Size size, int frames, double max_rms_error) {
  return noise::PlanOctaves(noise::ClassicOctaves(SumOf(blur), {}), noise::NoiseKind::kPerlin, size.width,
                            size.height, frames, {.rms = max_rms_error});
}

}  // namespace shimmer::sim
