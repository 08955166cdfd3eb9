// shimmer generate CONFIG --out DIR
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/app/clip_size.h"
#include "sim/dataset/pending.h"

namespace shimmer::app {

struct GenerateOptions {
  std::filesystem::path config, out;
  std::vector<std::string> sets;
  std::vector<int64_t> only_clips;  // empty: all
  dataset::Shard shard;
  bool retry_failed = false;  // clips that failed in an earlier run too
  bool dry_run = false;       // say what would be done, and what it takes
  bool wait = false;          // for another process that writes to the folder
  int threads = 0;            // 0: as many as the machine has
  int64_t memory_bytes = kDefaultMemory_bytes;
  bool quiet = false;

  // Of a config's clips. Throws std::invalid_argument for a clip that there is not.
  dataset::Wanted WantedOf(int64_t clips) const;
};

// Makes the clips that the folder does not have yet, several at a time; returns the exit code. A clip whose
// source is bad is noted as failed and the rest go on. Throws ConfigError and std::invalid_argument (nothing
// was touched), and std::runtime_error where the folder can't be written.
int Generate(const GenerateOptions& options, const std::atomic<bool>& stop);

}  // namespace shimmer::app
