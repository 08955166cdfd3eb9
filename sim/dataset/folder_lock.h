// Who may write to a data set's folder: one process for the whole set, or one for each shard. Held as long as
// the object lives, and given up by the system when its process dies, however it does.
//
// The lock is the system's (flock) on .lock, or .lock.003-of-008 of a shard, where the file system has such
// locks. On one that has none (some cluster file systems) the file itself says who holds it, host and
// process, and the holder renews its date: a holder is taken for dead whose process is gone on this host, or
// whose file is older than kStaleSeconds on another. Of two that begin at the same moment one is told so.
#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>

#include "sim/dataset/shard.h"

namespace shimmer::dataset {

inline constexpr const char* kLockName = ".lock";
inline constexpr int kRenewSeconds = 20, kStaleSeconds = 120;

// Another process writes there; what() says which.
struct FolderBusy : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class FolderLock {
 public:
  // Throws FolderBusy while the whole set is written by another process, or this shard is, or shards of
  // another count are; for the whole set, while any shard is. Other std::runtime_errors where the folder
  // can't be written.
  FolderLock(const std::filesystem::path& folder, const Shard& shard);
  ~FolderLock();
  FolderLock(FolderLock&&) noexcept;

 private:
  class Held;
  std::unique_ptr<Held> held_;
};

// The lock of the whole set for one who only reads; none where the folder can't be written to, for then
// nobody writes: an archive may be read too. Throws as FolderLock.
std::unique_ptr<FolderLock> LockToRead(const std::filesystem::path& folder);

}  // namespace shimmer::dataset
