// What `unshimmer evaluate` is asked, on the command line.
#pragma once

#include <CLI/CLI.hpp>

#include "restore/app/evaluation/evaluate.h"

namespace shimmer::restore::app {

void AddEvaluateOptions(CLI::App& command, EvaluateOptions& options);

}  // namespace shimmer::restore::app
