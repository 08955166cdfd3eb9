// Whether a data set's folder holds files and folders of its own alone.
#pragma once

#include <filesystem>

#include "sim/dataset/layout.h"

namespace shimmer::dataset {

// Looks at everything that writing goes by: what a link leads to would be written, or removed, outside; a
// pipe would be waited for. Throws std::invalid_argument "PATH: what it is, and what it must be".
void RequireOwnEntries(const std::filesystem::path& folder, const Layout& layout);

}  // namespace shimmer::dataset
