// The page of an evaluation: one file that opens from disk, with its pictures, style and script inside.
#pragma once

#include <filesystem>
#include <string>

#include "restore/app/evaluation/results.h"

namespace shimmer::restore::app {

// folder: REPORT, whose pictures (pictures.h) are taken into the page where they are there.
std::string EvaluationHtml(const Evaluation& evaluation, const std::filesystem::path& folder);

}  // namespace shimmer::restore::app
