// What the values of a config must be to each other, beyond the range that each has.
#pragma once

#include "sim/app/config/params.h"

namespace shimmer::app {

// resolved: complete, each value checked by itself; fixed: its values that hold for the whole set.
// Where a value is drawn, the rule must hold whatever is drawn. Throws ConfigError.
void CheckRules(const Json& resolved, const Config& fixed);

// Those of scenes that move; part of CheckRules.
void CheckSceneRules(const Json& resolved, const Config& fixed);

}  // namespace shimmer::app
