// Hashes of source files, remembered in the data set's folder from run to run: a hundred thousand photographs
// take minutes to read.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace shimmer::dataset {

inline constexpr const char* kHashMemoryName = ".sources";

class HashMemory {
 public:
  // With what the folder remembers: nothing where there is no such file, or a damaged one.
  explicit HashMemory(const std::filesystem::path& folder);

  // SHA-256 of a file's bytes; not read again where size and time of change are those that are remembered.
  // For any number of threads. Throws std::runtime_error if it can't be read, Interrupted once stop is set.
  std::string HashOf(const std::filesystem::path& file, const std::atomic<bool>& stop);

  // Remembers, for the next run, the files that HashOf was asked for. It is no error if they can't be written
  // there: the next run reads the files again.
  void Write(const std::filesystem::path& folder) const;

 private:
  struct Known {
    uint64_t bytes;
    int64_t mtime_ns;
    std::string sha256;
  };
  using Hashes = std::map<std::string, Known>;  // by absolute path

  void Parse(const std::vector<uint8_t>& bytes);

  Hashes known_;
  std::string hash_of_known_;
  mutable std::mutex mutex_;  // of what follows
  Hashes asked_;
};

}  // namespace shimmer::dataset
