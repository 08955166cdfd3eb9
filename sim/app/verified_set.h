// What is wrong with a data set, all of it, found on all threads.
#pragma once

#include <atomic>
#include <filesystem>
#include <set>
#include <vector>

#include "sim/dataset/verify.h"

namespace shimmer::app {

struct VerifiedSet {
  std::vector<dataset::Problem> problems;  // by clip, then by name; those of no clip last
  int64_t clips = 0;                       // of the config, and any beyond that are done
  int64_t whole = 0, failed = 0;           // of them
  int64_t files = 0;                       // that the manifest names
  std::set<int64_t> one_clean;             // dataset::UnitFindings
};

// before, where not null: what was found earlier; only the clips that were not whole then are looked at
// again. Ends early, with less, when stop is set. Throws std::runtime_error where dataset.json can't be read.
VerifiedSet VerifySet(const std::filesystem::path& folder, const VerifiedSet* before, int threads, bool quiet,
                      const std::atomic<bool>& stop);

}  // namespace shimmer::app
