// One text for one config, so that equal configs have equal hashes on any machine and in any language.
#pragma once

#include <string>

#include "sim/app/config/error.h"

namespace shimmer::app {

// What Python's json.dumps(value, sort_keys=True, separators=(",", ":")) writes: keys sorted by their bytes,
// ASCII, numbers the shortest that read back the same ("5.0", "1e-06"). No value may be infinite.
std::string CanonicalText(const Json& value);

}  // namespace shimmer::app
