#include "sim/dataset/unite.h"

#include <vector>

#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/files.h"
#include "sim/dataset/glob.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

constexpr size_t kLinesAtOnce = 500;

}  // namespace

void UniteManifests(const fs::path& folder, const FolderLock&, const Manifest::Damaged& damaged) {
  const std::vector<fs::path> manifests = ManifestsIn(folder);
  // What kills have left in staging folders says what else must be cleared away, and stays for the next
  // writer.
  const fs::path beside = folder / kStagingName / kManifestName;
  MakeFolders(beside.parent_path());
  RemoveAll(beside);
  {
    const Manifest all(manifests, damaged);
    ManifestWriter united(beside, 0);
    std::vector<Json> lines;
    const auto add = [&] {
      united.Append(lines);
      lines.clear();
    };
    all.ForEachLine([&](int64_t, const Json& line) {
      lines.push_back(line);
      if (lines.size() >= kLinesAtOnce) add();
    });
    add();
  }
  Rename(beside, manifests[0]);
  SyncFolder(folder);
  for (size_t i = 1; i < manifests.size(); ++i) RemoveAll(manifests[i]);
  for (const fs::path& left : ExpandGlob(folder, std::string(kLockName) + ".*-of-*")) RemoveAll(left);
  std::error_code not_empty;
  fs::remove(beside.parent_path(), not_empty);
  SyncFolder(folder);
}

}  // namespace shimmer::dataset
