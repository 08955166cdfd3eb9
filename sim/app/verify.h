// shimmer verify DIR
#pragma once

#include <atomic>
#include <filesystem>

namespace shimmer::app {

struct VerifyOptions {
  std::filesystem::path folder;
  bool repair = false;
  std::filesystem::path config_folder;  // that relative sources count from; empty: as generate has noted
  int threads = 0;                      // 0: as many as the machine has
  bool quiet = false;                   // prints the summary alone
};

// Looks at every clip and file of a data set, prints what is wrong, a line each, and a summary. With repair:
// makes clips again that are not whole, replacing the files alone that are wrong, moves what is too much to
// DIR/.surplus, and looks at all of that once more. Returns the exit code: failed where anything is wrong (in
// the end), or clips have failed. Throws std::invalid_argument where the folder is no data set,
// dataset::FolderBusy while a process writes to it, and std::runtime_error, before anything is changed, where
// it can't be repaired.
int Verify(const VerifyOptions& options, const std::atomic<bool>& stop);

}  // namespace shimmer::app
