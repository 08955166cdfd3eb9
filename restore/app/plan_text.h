// A plan as people and as programs read it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "restore/plan.h"
#include "restore/sharpen.h"
#include "restore/turbulence_strength.h"

namespace shimmer::restore::app {

// optics: with them Cn2 is given, without them what it is proportional to.
std::string PlanText(const VideoFacts& facts, const RestorePlan& plan, const std::optional<Optics>& optics);

// {"size", "frames", "grey", "stabilise", "fill", "area", "skipped", "shifts_px": [[x, y], ...], ...}.
// counts: what became of the tiles that were to be sharpened.
nlohmann::ordered_json PlanJson(const VideoFacts& facts, const RestorePlan& plan,
                                const SharpenCounts& counts);

}  // namespace shimmer::restore::app
