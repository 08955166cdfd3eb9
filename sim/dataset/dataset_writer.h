// Writes a data set clip by clip. A clip exists or it does not: its files are written and synced beside
// (.staging), renamed into place, and only then named in the manifest; what a kill leaves half done is not
// there afterwards.
//
// Layout sequence renames a clip's folder at once. Layout pairs renames file by file, so a kill in between
// leaves files without a manifest line; opening the folder again removes them.
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "sim/dataset/files.h"
#include "sim/dataset/layout.h"
#include "sim/dataset/manifest.h"

namespace shimmer::dataset {

struct ClipFile {
  std::string path;  // relative to the data set's folder, as Layout::Path gives it
  std::vector<uint8_t> bytes;
  std::string pixel_hash;  // pixel_hash.h; empty for what is no picture
};

class DatasetWriter {
 public:
  // Opens or makes the folder. description: what dataset.json says (dataset_difference.h).
  // Throws std::invalid_argument: the folder holds other files, or a data set made from something else (each
  // difference is named; `clips` may differ). Throws std::runtime_error: another process writes there; it
  // can't be written; its manifest is damaged.
  DatasetWriter(std::filesystem::path folder, Layout layout, const Json& description);

  ~DatasetWriter();

  // Clips that need no more work, and clips whose last attempt failed.
  std::set<int64_t> done() const;
  std::set<int64_t> failed() const;

  // Both may be called by several threads, each with its own clip; both fill in "clip" and "status".
  // Commit adds "files": [{path, pixels, sha256}]. If it throws (full, unwritable), nothing of the clip is
  // there.
  void Commit(int64_t clip, std::span<const ClipFile> files, Json line);
  void Fail(int64_t clip, Json line);  // line["error"] says why

 private:
  bool IsDone(int64_t clip) const;
  std::filesystem::path StagingOf(int64_t clip) const;
  std::filesystem::path NameInStaging(int64_t clip, const std::string& path) const;
  void CleanStaging() const;
  void Stage(int64_t clip, std::span<const ClipFile> files) const;
  void Publish(int64_t clip, std::span<const ClipFile> files) const;
  void Remove(int64_t clip) const;
  void Append(int64_t clip, const char* status, Json line);

  std::filesystem::path folder_;
  Layout layout_;
  FileHandle lock_;
  mutable std::mutex mutex_;  // of what follows
  std::set<int64_t> done_, failed_;
  std::optional<ManifestWriter> manifest_;
};

}  // namespace shimmer::dataset
