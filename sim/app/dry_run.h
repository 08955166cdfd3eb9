// shimmer generate --dry-run: what a run would do and take, with nothing written.
#pragma once

#include <atomic>

#include "sim/app/generate.h"

namespace shimmer::app {

// Prints clips, frames, files, bytes and time, the last two from a few clips that are made in memory, and
// what is free. Returns the exit code. Throws as Generate does, and std::runtime_error where the target can't
// hold it.
int DryRun(const GenerateOptions& options, const std::atomic<bool>& stop);

}  // namespace shimmer::app
