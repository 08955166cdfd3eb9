// unshimmer compare: how near one sequence is to another, and how straight and steady each is.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>

namespace shimmer::restore::app {

struct CompareOptions {
  std::filesystem::path a, b, mask, json, slices;  // the last three may be empty: not wanted
  std::optional<int> row;                          // of the slices
  bool are_masks = false;                          // A and B
  int threads = 0;                                 // 0: all
  bool quiet = false;
};

// Prints the table, writes what is wanted, and returns the exit code. Throws as OpenFrames and
// CompareSequences do, and std::runtime_error for a file that can't be written.
int Compare(const CompareOptions& options, const std::atomic<bool>& stop);

}  // namespace shimmer::restore::app
