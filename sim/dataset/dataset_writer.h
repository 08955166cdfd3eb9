// Writes a data set clip by clip, many at a time. A clip exists or it does not: its files are written beside
// (staged_clip.h); a thread of the writer's own syncs all that have come in the meantime at once, moves them
// into place, and only then names them in the manifest. What a kill leaves half done is not there afterwards,
// and costs at most a group and the clips in hand.
//
// Layouts that have folders for a clip alone move those at once. Others move file by file, so a kill in
// between leaves files without a manifest line; opening the folder again removes them. Of webdataset a tar is
// written and named when all its clips are there.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim/dataset/folder_lock.h"
#include "sim/dataset/group_commit.h"
#include "sim/dataset/layout.h"
#include "sim/dataset/manifest.h"
#include "sim/dataset/shard.h"
#include "sim/dataset/staged_clip.h"

namespace shimmer::dataset {

class DatasetWriter {
 public:
  // Opens or makes the folder. Manifests of shards are made one where the whole set is written. description:
  // what dataset.json says (dataset_difference.h). Throws std::invalid_argument: the folder holds other files
  // or links, or a data set made from something else (each difference is named; `clips` may differ), tars of
  // shards of another count. Throws FolderBusy: another process writes there, and std::runtime_error: it
  // can't be written; its manifest is damaged.
  DatasetWriter(std::filesystem::path folder, Layout layout, const Json& description,
                const Shard& shard = {});

  // Waits for the group in hand; what no Flush has waited for may be dropped.
  ~DatasetWriter();

  // Clips that are there, and clips whose last attempt failed: as any process left them, and this one since.
  std::set<int64_t> done() const;
  std::set<int64_t> failed() const;

  const Layout& layout() const { return layout_; }
  const std::filesystem::path& folder() const { return folder_; }

  // The place for a clip's files. May be called by several threads.
  StagedClip Stage(int64_t clip) const { return {staging_, clip, layout_.IsTars()}; }

  // All fill in "clip" and "status"; Commit and Repair add "files": [{path, bytes,
  // sha256, pixels}]. They return before anything is durable, and throw what went wrong with an earlier clip:
  // of the clips whose group failed (full, unwritable) nothing is there. Clips of a tar come in their order,
  // one after the other; others may come from several threads.
  void Commit(StagedClip clip, Json line);
  void Fail(int64_t clip, Json line);       // line["error"] says why
  void Repair(StagedClip clip, Json line);  // of a clip that is done: those files alone that differ
  void Flush();                             // waits until all of it is durable

  // Takes clips over from another data set: their lines as they are, and the files that those name, linked or
  // copied from that folder. Durable when it returns.
  void Adopt(const std::filesystem::path& from, const std::vector<Json>& lines);

 private:
  struct Entry {
    int64_t clip;
    std::optional<StagedClip> staged;  // none: it failed
    Json line;
    bool repair = false;
  };

  bool IsDone(int64_t clip) const;
  void RequireOwnPaths(const StagedClip& clip) const;
  void CommitGroup(std::vector<Entry> group);
  void Publish(std::vector<Entry>& entries);
  std::set<std::filesystem::path> Move(const Entry& entry) const;
  std::set<std::filesystem::path> MoveDiffering(const StagedClip& staged) const;
  void PublishTar(std::vector<Entry>& unit) const;
  void AppendLines(std::vector<Entry>& entries);
  void Note(int64_t clip, bool done);
  void RequireSameShards(const Shard& shard) const;
  std::vector<Entry> CompleteUnits(std::vector<Entry> group);
  void CleanUp(const Shard& shard) const;
  void Remove(int64_t clip) const;

  std::filesystem::path folder_, staging_;
  Layout layout_;
  FolderLock lock_;
  int64_t clips_;      // of the config
  Manifest manifest_;  // as it was when this process began
  std::optional<ManifestWriter> lines_;
  mutable std::mutex mutex_;  // of what follows
  std::set<int64_t> done_, failed_;
  std::vector<Entry> unit_;  // of a tar that is not complete; of the committing thread alone
  std::unique_ptr<GroupCommit<Entry>> commits_;
};

}  // namespace shimmer::dataset
