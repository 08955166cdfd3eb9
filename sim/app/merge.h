// shimmer merge DIR [FROM...]
#pragma once

#include <filesystem>
#include <vector>

namespace shimmer::app {

struct MergeOptions {
  std::filesystem::path folder;
  std::vector<std::filesystem::path> from;  // folders of shards; empty: the shards wrote to `folder` itself
};

// Makes one data set of shards, equal to that of a run without shards, and prints what is missing of it, by
// shards. Returns the exit code: failed where clips are missing or failed. Throws std::invalid_argument where
// the folders are made from different things, std::runtime_error.
int Merge(const MergeOptions& options);

}  // namespace shimmer::app
