// How much a clip takes at the most, known from the config alone.
#pragma once

#include <cstdint>

#include "sim/app/config/config.h"

namespace shimmer::app {

// As many clips as a tar of output.tar_mb holds whatever they show (one at least): where a clip lies must not
// hang on how well others compress. one_clean: all clean frames of a clip are one.
int64_t ClipsPerTar(const ConfigFile& config, bool one_clean);

// What `shimmer generate` may hold in memory, and what it does with it.
struct MemoryPlan {
  int64_t sources_bytes;  // decoded pictures that are kept
  int clips_at_once;
};

// Clips at once: one a thread, or fewer where so many would take more than the budget; one at least. What
// they leave is for sources.
MemoryPlan PlanMemory(int64_t budget_bytes, const ConfigFile& config, int threads);

inline constexpr int64_t kDefaultMemory_bytes = int64_t{1} << 30;

}  // namespace shimmer::app
