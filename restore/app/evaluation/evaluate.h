// unshimmer evaluate
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <vector>

#include "restore/app/evaluation/variants.h"
#include "sim/dataset/shard.h"

namespace shimmer::restore::app {

struct EvaluateOptions {
  std::filesystem::path set, adapter, out;  // set may be empty where there are real videos
  std::vector<std::filesystem::path> real;
  VariantOptions variants;
  int64_t clips = 0;  // the first so many; 0: all
  dataset::Shard shard;
  int jobs = 1;     // clips at a time
  int threads = 0;  // 0: all
  bool quiet = false;
};

// Evaluates what is not evaluated yet, and writes the report of all that is. Returns the exit code: 1 where a
// clip failed, whose error is recorded while the rest goes on. Throws as the sets, VariantsOf and
// ReportFolder do, with nothing touched.
int Evaluate(const EvaluateOptions& options, const std::atomic<bool>& stop);

}  // namespace shimmer::restore::app
