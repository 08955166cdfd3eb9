#include "sim/dataset/merge.h"

#include <fcntl.h>

#include <stdexcept>

#include "sim/dataset/dataset_difference.h"
#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/dataset_reader.h"
#include "sim/dataset/files.h"
#include "sim/dataset/glob.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

// Clips that are made durable at once.
constexpr size_t kClipsAtOnce = 500;

}  // namespace

void Adopt(DatasetWriter& writer, const fs::path& from) {
  const FolderLock lock(from, {});
  const DatasetReader other(from);
  const std::vector<std::string> differences =
      Differences(ReadDescription(writer.folder()), other.description());
  if (!differences.empty())
    throw std::invalid_argument(from.string() + ": is made from something else than " +
                                writer.folder().string() + ": " + InOneLine(differences));
  const std::set<int64_t> done = writer.done(), failed = writer.failed();
  std::vector<Json> lines;
  const auto add = [&] {
    writer.Adopt(from, lines);
    lines.clear();
  };
  other.manifest().ForEachLine([&](int64_t clip, const Json& line) {
    const bool is_done = other.clips().contains(clip);
    if (done.contains(clip) || (!is_done && failed.contains(clip))) return;
    lines.push_back(line);
    // Clips of one tar stay together.
    if (lines.size() >= kClipsAtOnce && (clip + 1) % writer.layout().ClipsPerUnit() == 0) add();
  });
  add();
}

void UniteManifests(const fs::path& folder, const Manifest::Damaged& damaged) {
  const FolderLock lock(folder, {});
  const std::vector<fs::path> manifests = ManifestsIn(folder);
  {
    const fs::path beside = folder / kStagingName / kManifestName;
    MakeFolders(beside.parent_path());
    const Manifest all(manifests, damaged);
    RemoveAll(beside);
    {
      ManifestWriter united(beside, 0);
      std::vector<Json> lines;
      const auto add = [&] {
        united.Append(lines);
        lines.clear();
      };
      all.ForEachLine([&](int64_t, const Json& line) {
        lines.push_back(line);
        if (lines.size() >= kClipsAtOnce) add();
      });
      add();
    }
    Rename(beside, manifests[0]);
    SyncFolder(folder);
    for (size_t i = 1; i < manifests.size(); ++i) RemoveAll(manifests[i]);
  }
  RemoveAll(folder / kStagingName);
  for (const char* of_shards : {kLockName, kStagingName})
    for (const fs::path& left : ExpandGlob(folder, std::string(of_shards) + ".*-of-*")) RemoveAll(left);
  SyncFolder(folder);
}

}  // namespace shimmer::dataset
