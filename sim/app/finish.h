// What a data set gets when a run has ended: the files that training code reads beside the pictures, and a
// page about it for people.
#pragma once

#include <filesystem>

#include "sim/dataset/layout.h"

namespace shimmer::app {

// Writes what is derived from the manifest: the layout's own files (sim/dataset/derived_files.h) and
// report.html (sim/app/report.h). The same clips give the same bytes.
void FinishDataset(const std::filesystem::path& folder, const dataset::Layout& layout);

// Whether an earlier run has done so, and nothing was made since.
bool IsFinished(const std::filesystem::path& folder);

}  // namespace shimmer::app
