// What DatasetWriter does for sets of tars: a tar is written when all its clips are there.
#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "sim/dataset/dataset_writer.h"
#include "sim/dataset/numbered_name.h"
#include "sim/dataset/pending.h"
#include "sim/dataset/tar.h"
#include "sim/dataset/tar_swap.h"

namespace shimmer::dataset {

namespace fs = std::filesystem;

// Tars that shards of another count have written may be written again by this one; of two manifests with a
// clip the right one would be anyone's guess.
void DatasetWriter::RequireSameShards(const Shard& shard) const {
  if (shard.whole() || !layout_.IsTars()) return;
  for (const fs::path& path : manifest_.paths()) {
    const std::optional<Shard> other = ShardOfManifest(path.filename().string());
    if (other && other->count != shard.count)
      throw std::invalid_argument(folder_.string() + ": shards of " + std::to_string(other->count) +
                                  " have written tars there (" + path.filename().string() +
                                  "): make one set of them with `shimmer merge` before shards of " +
                                  std::to_string(shard.count));
  }
}

// Of a set of tars: the entries whose tar is complete with them. The rest waits.
std::vector<DatasetWriter::Entry> DatasetWriter::CompleteUnits(std::vector<Entry> group) {
  std::vector<Entry> complete;
  for (Entry& entry : group) {
    const int64_t unit = layout_.UnitOf(entry.clip);
    if (!unit_.empty() && layout_.UnitOf(unit_.front().clip) != unit) unit_.clear();
    unit_.push_back(std::move(entry));
    const int64_t end = UnitEnd(layout_, unit, clips_, manifest_.done(), manifest_.failed());
    if (unit * layout_.clips_per_tar + static_cast<int64_t>(unit_.size()) < end) continue;
    std::ranges::move(unit_, std::back_inserter(complete));
    unit_.clear();
  }
  return complete;
}

// All clips of one tar. What was there under its name is replaced.
void DatasetWriter::PublishTar(std::vector<Entry>& unit) const {
  const std::string tar_path = layout_.TarPath(layout_.UnitOf(unit.front().clip));
  std::vector<TarMember> members;
  for (Entry& entry : unit) {
    if (!entry.staged) continue;
    const std::string text = entry.line.dump(-1, ' ', false, Json::error_handler_t::replace);
    entry.staged->Add({tar_path + "/" + Padded(entry.clip, 6) + ".json", {text.begin(), text.end()}, ""});
    for (const StoredFile& file : entry.staged->files())
      members.push_back({.name = file.path.substr(tar_path.size() + 1),
                         .place = entry.staged->PlaceOf(file.path),
                         .bytes = file.bytes,
                         .first = file.offset});
  }
  const fs::path to = folder_ / tar_path, beside = staging_ / to.filename();
  KeepTar(to, staging_);                      // until the manifest names the new one
  if (members.empty()) return RemoveAll(to);  // all of them failed; an empty tar would be read as a fault
  MakeFolders(to.parent_path());
  const std::vector<int64_t> offsets = WriteTar(beside, members);
  Rename(beside, to);
  SyncFolder(to.parent_path());
  size_t member = 0;
  for (Entry& entry : unit) {
    if (!entry.staged) continue;
    entry.line["files"] = Json::array();
    for (StoredFile file : entry.staged->files()) {
      file.path = tar_path;
      file.member = members[member].name;
      file.offset = offsets[member++];
      entry.line["files"].push_back(ToJson(file));
    }
  }
}

}  // namespace shimmer::dataset
