// How the fields of a clip are evaluated within their share of the accuracy: noise::PlanOctaves for the
// scene's parameters.
#pragma once

#include <opencv2/core.hpp>

#include "noise/field_plan.h"
#include "sim/scene.h"

namespace shimmer::sim {

// Each axis of the tilt over a clip of size px and a border around it; errors in px, the RMS over the clip.
noise::FieldPlan PlanTiltField(const TiltParams& tilt, cv::Size size, int frames, noise::ErrorBudget budget,
                               int border_px = 0);

// The Perlin part of the sigma map; errors in the noise's unit.
noise::FieldPlan PlanBlurNoise(const BlurParams& blur, cv::Size size, int frames, double max_rms_error);

}  // namespace shimmer::sim
