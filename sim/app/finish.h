// What a data set gets when a run has ended: the files that training code reads beside the pictures.
#pragma once

#include <filesystem>

#include "sim/dataset/layout.h"

namespace shimmer::app {

// Writes what is derived from the manifest: the layout's own files (sim/dataset/derived_files.h). The same
// clips give the same bytes.
void FinishDataset(const std::filesystem::path& folder, const dataset::Layout& layout);

}  // namespace shimmer::app
