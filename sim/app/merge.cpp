#include "sim/app/merge.h"

#include <cstdio>
#include <map>
#include <optional>
#include <set>

#include "cli/exit_codes.h"
#include "cli/number_text.h"
#include "sim/app/finish.h"
#include "sim/app/job.h"
#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/dataset_reader.h"
#include "sim/dataset/merge.h"
#include "sim/dataset/unite.h"

namespace shimmer::app {
namespace {

// N of manifest.003-of-008.jsonl, where shards of one count have written them.
std::optional<int64_t> ShardCountIn(const std::vector<std::filesystem::path>& folders) {
  std::set<int64_t> counts;
  for (const auto& folder : folders)
    for (const auto& manifest : dataset::ManifestsIn(folder))
      if (const auto shard = dataset::ShardOfManifest(manifest.filename().string()))
        counts.insert(shard->count);
  return counts.size() == 1 ? std::optional(*counts.begin()) : std::nullopt;
}

}  // namespace

int Merge(const MergeOptions& options) {
  std::vector<std::filesystem::path> folders = options.from;
  folders.push_back(options.folder);
  const std::optional<int64_t> shards = ShardCountIn(folders);
  const bool is_there =
      options.from.empty() || std::filesystem::exists(options.folder / dataset::kDescriptionName);
  const std::filesystem::path& described = is_there ? options.folder : options.from[0];
  const Json description = dataset::ReadDescription(described);
  const dataset::Layout layout = LayoutOfDataset(described, description);
  // All of them, before anything is changed.
  for (const auto& from : options.from) dataset::RequireSameDataset(from, description, described);
  {
    dataset::DatasetWriter writer(options.folder, layout, description);  // clears away what kills have left
    for (const auto& from : options.from) dataset::Adopt(writer, from);
  }
  dataset::UniteManifests(options.folder, dataset::FolderLock(options.folder, {}));
  FinishDataset(options.folder, layout);

  const dataset::DatasetReader set(options.folder);
  const int64_t clips = ConfigOfDataset(options.folder, description).fixed().clips;
  int64_t done = 0, failed = 0;
  std::map<int64_t, int64_t> missing_of_shard;
  for (int64_t clip = 0; clip < clips; ++clip) {
    if (set.clips().contains(clip))
      ++done;
    else if (set.failed().contains(clip))
      ++failed;
    else
      ++missing_of_shard[shards ? layout.UnitOf(clip) % *shards : 0];
  }
  std::printf("%s: %lld of %s done, %lld failed\n", options.folder.c_str(), static_cast<long long>(done),
              cli::Counted(clips, "clip").c_str(), static_cast<long long>(failed));
  for (const auto& [shard, missing] : missing_of_shard) {
    const std::string whose =
        shards ? "shard " + std::to_string(shard) + "/" + std::to_string(*shards) + ": " : "";
    std::printf("%s%s missing\n", whose.c_str(), cli::Counted(missing, "clip").c_str());
  }
  return done == clips ? cli::kExitDone : cli::kExitFailed;
}

}  // namespace shimmer::app
