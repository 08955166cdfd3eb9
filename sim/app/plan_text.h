// A clip's plan as people and manifests read it.
#pragma once

#include <string>
#include <vector>

#include "sim/app/config/config.h"
#include "sim/plan.h"

namespace shimmer::app {

// {"tilt": {...} or null, "blur": {...} or null, "halo_px": ..., ...}: null is skipped.
Json PlanJson(const sim::ClipPlan& plan);

// A line for each thing that the clip does not need and nobody computes.
std::vector<std::string> SkippedLines(const Config& config, const sim::ClipPlan& plan);

}  // namespace shimmer::app
