// Makes a data set whole again where verifying has found it is not.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/app/verified_set.h"

namespace shimmer::app {

struct Repaired {
  int64_t clips_made = 0;           // again, or for the first time
  std::vector<std::string> moved;   // "PATH: moved to .surplus/PATH"
  std::vector<std::string> errors;  // of clips that were there and can't be made any more: untouched
};

// config_folder: as Job::OfDataset takes it; empty: as it is noted in the folder. Throws std::runtime_error
// where clips are to be made and can't be: before anything is changed if the sources are not what they were,
// later where the target can't be written. Ends early when stop is set: what is made by then is durable.
Repaired Repair(const std::filesystem::path& folder, const VerifiedSet& found,
                const std::filesystem::path& config_folder, int threads, bool quiet,
                const std::atomic<bool>& stop);

}  // namespace shimmer::app
