// Options for Restormer's own training code (its fork of BasicSR), for a data set of layout restormer.
#pragma once

#include <cstdint>
#include <string>

namespace shimmer::dataset {

// YAML. smallest_side_px: of all frames; no training patch is larger. with_test: whether there are test clips
// to validate with (its code fails on an empty folder).
std::string RestormerOptions(const std::string& name, int64_t smallest_side_px, bool with_test);

}  // namespace shimmer::dataset
