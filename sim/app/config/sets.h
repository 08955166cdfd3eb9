// --set tilt.strength_px=5: a key of the config given on the command line.
#pragma once

#include <string>

#include "sim/app/config/error.h"

namespace shimmer::app {

// Puts the value of "PATH=VALUE" into the config as it was given, or takes the key away where VALUE is null.
// VALUE is JSON, or else text. given: an object. Throws ConfigError.
void ApplySet(const std::string& set, Json& given);

}  // namespace shimmer::app
