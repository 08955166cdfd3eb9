// The page of an evaluation.
#pragma once

#include <filesystem>
#include <string>

#include "restore/app/evaluation/results.h"

namespace shimmer::restore::app {
std::string EvaluationHtml(const Evaluation& evaluation, const std::filesystem::path& folder);
}  // namespace shimmer::restore::app
