// A plan as people and as programs read it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "restore/plan.h"

namespace shimmer::restore::app {

std::string PlanText(const VideoFacts& facts, const RestorePlan& plan);

// {"size", "frames", "grey", "stabilise", "fill", "area", "skipped", "shifts_px": [[x, y], ...], ...}.
nlohmann::ordered_json PlanJson(const VideoFacts& facts, const RestorePlan& plan);

}  // namespace shimmer::restore::app
