#include "sim/dataset/dataset_writer.h"

#include <fcntl.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/glob.h"
#include "sim/dataset/own_entries.h"
#include "sim/dataset/sha256.h"
#include "sim/dataset/tar_swap.h"
#include "sim/dataset/unite.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

// What a kill may cost: clips that were made and are not named in the manifest yet (and the tar that they
// belong to).
constexpr size_t kMostWaiting = 64;

fs::path ManifestOf(const fs::path& folder, const Shard& shard) {
  return folder / ("manifest" + shard.Suffix() + ".jsonl");
}

std::vector<Json> FilesJson(const std::vector<StoredFile>& files) {
  std::vector<Json> json;
  for (const StoredFile& file : files) json.push_back(ToJson(file));
  return json;
}

}  // namespace

DatasetWriter::DatasetWriter(fs::path folder, Layout layout, const Json& description, const Shard& shard)
    : folder_(std::move(folder)),
      staging_(folder_ / (kStagingName + shard.Suffix())),
      layout_(std::move(layout)),
      lock_((layout_.Validate(), shard.Validate(), MakeDatasetFolder(folder_),
             RequireOwnEntries(folder_, layout_), FolderLock(folder_, shard))),
      clips_((WriteDescription(folder_, description), description.at("config").value("clips", int64_t{0}))),
      manifest_(ManifestsIn(folder_)),
      done_(manifest_.done()),
      failed_(manifest_.failed()) {
  RequireSameShards(shard);
  CleanUp(shard);
  if (shard.whole() && manifest_.paths().size() > 1) {
    // A shard's line must not count for more than one that is written now.
    UniteManifests(folder_, lock_);
    manifest_ = Manifest(ManifestsIn(folder_));
  }
  const fs::path own = ManifestOf(folder_, shard);
  lines_.emplace(own, manifest_.whole_bytes(own));
  commits_ = std::make_unique<GroupCommit<Entry>>(
      kMostWaiting, [this](std::vector<Entry> group) { CommitGroup(std::move(group)); });
}

DatasetWriter::~DatasetWriter() {
  commits_.reset();
  unit_.clear();
  try {
    SettleKeptTars(folder_, staging_);
    RemoveAll(staging_);
  } catch (const std::exception&) {
    // Opening the data set again cleans up.
  }
}

std::set<int64_t> DatasetWriter::done() const {
  const std::lock_guard guard(mutex_);
  return done_;
}

std::set<int64_t> DatasetWriter::failed() const {
  const std::lock_guard guard(mutex_);
  return failed_;
}

bool DatasetWriter::IsDone(int64_t clip) const {
  const std::lock_guard guard(mutex_);
  return done_.contains(clip);
}

void DatasetWriter::RequireOwnPaths(const StagedClip& clip) const {
  const std::vector<std::string> folders = layout_.ClipFolders(clip.clip());
  for (const StoredFile& file : clip.files())
    if (!folders.empty() && std::ranges::none_of(folders, [&](const std::string& folder) {
          return file.path.starts_with(folder + "/");
        }))
      throw std::invalid_argument("'" + file.path + "' is no place for a file of clip " +
                                  std::to_string(clip.clip()));
}

void DatasetWriter::Commit(StagedClip staged, Json line) {
  const int64_t clip = staged.clip();
  if (clip < 0 || (IsDone(clip) && !layout_.IsTars()))
    throw std::invalid_argument("clip " + std::to_string(clip) + " is done already or no clip");
  RequireOwnPaths(staged);
  commits_->Push({.clip = clip, .staged = std::move(staged), .line = std::move(line)});
}

void DatasetWriter::Fail(int64_t clip, Json line) {
  commits_->Push({.clip = clip, .staged = {}, .line = std::move(line)});
}

void DatasetWriter::Repair(StagedClip staged, Json line) {
  RequireOwnPaths(staged);
  const int64_t clip = staged.clip();
  commits_->Push({.clip = clip, .staged = std::move(staged), .line = std::move(line), .repair = true});
}

void DatasetWriter::Flush() { commits_->Flush(); }

void DatasetWriter::CommitGroup(std::vector<Entry> group) {
  for (Entry& entry : group) {
    entry.line["clip"] = static_cast<uint64_t>(entry.clip);
    entry.line["status"] = entry.staged ? "done" : "failed";
  }
  if (layout_.IsTars()) group = CompleteUnits(std::move(group));
  if (group.empty()) return;
  try {
    Publish(group);
    AppendLines(group);
  } catch (...) {
    try {
      // As the disk has it: of lines that can't be synced it is not sure that they can be taken back.
      const Manifest now(ManifestsIn(folder_));
      for (const Entry& entry : group)
        if (!now.done().contains(entry.clip)) Remove(entry.clip);
    } catch (const std::exception&) {
      // The first error is the one to tell; opening the folder again cleans up.
    }
    throw;
  }
}

void DatasetWriter::Publish(std::vector<Entry>& entries) {
  if (layout_.IsTars()) {
    for (auto begin = entries.begin(); begin != entries.end();) {
      const int64_t unit = layout_.UnitOf(begin->clip);
      const auto end = std::find_if(begin, entries.end(),
                                    [&](const Entry& entry) { return layout_.UnitOf(entry.clip) != unit; });
      std::vector<Entry> of_tar(std::make_move_iterator(begin), std::make_move_iterator(end));
      PublishTar(of_tar);
      begin = std::move(of_tar.begin(), of_tar.end(), begin);
    }
    return;
  }
  if (std::ranges::any_of(entries, [](const Entry& entry) { return entry.staged.has_value(); }))
    FileHandle(folder_, O_RDONLY | O_DIRECTORY).SyncFileSystem();
  std::set<fs::path> changed;
  for (Entry& entry : entries) {
    if (!entry.staged) {
      Remove(entry.clip);
      continue;
    }
    changed.merge(entry.repair ? MoveDiffering(*entry.staged) : Move(entry));
    entry.line["files"] = FilesJson(entry.staged->files());
  }
  for (const fs::path& folder : changed) SyncFolder(folder);
}

// Gives the folders that must be synced.
std::set<fs::path> DatasetWriter::Move(const Entry& entry) const {
  std::set<fs::path> changed;
  std::vector<std::string> moved = layout_.ClipFolders(entry.clip);
  if (moved.empty())
    for (const StoredFile& file : entry.staged->files()) moved.push_back(file.path);
  for (const std::string& name : moved) {
    const fs::path from = entry.staged->PlaceOf(name), to = folder_ / name;
    if (!fs::exists(from)) continue;  // a kind of frame that this clip has not
    MakeFolders(to.parent_path());
    // There may be a folder from a kill between this move and the manifest; out of the way it goes.
    if (fs::is_directory(to)) RemoveAll(to);
    Rename(from, to);
    changed.insert(to.parent_path());
  }
  return changed;
}

std::set<fs::path> DatasetWriter::MoveDiffering(const StagedClip& staged) const {
  std::set<fs::path> changed;
  for (const StoredFile& file : staged.files()) {
    const fs::path to = folder_ / file.path;
    if (fs::is_regular_file(to) && Sha256HexOfFile(to) == file.sha256) continue;
    MakeFolders(to.parent_path());
    if (fs::is_directory(to)) RemoveAll(to);
    Rename(staged.PlaceOf(file.path), to);
    changed.insert(to.parent_path());
  }
  return changed;
}

void DatasetWriter::AppendLines(std::vector<Entry>& entries) {
  std::vector<Json> lines;
  for (Entry& entry : entries) {
    // What was repaired to what it was needs no line of its own.
    const bool known = entry.staged && manifest_.done().contains(entry.clip);
    if (!known || manifest_.Line(entry.clip) != entry.line) lines.push_back(std::move(entry.line));
  }
  lines_->Append(lines);
  if (layout_.IsTars()) DropKeptTars(staging_);
  for (const Entry& entry : entries) Note(entry.clip, entry.staged.has_value());
}

void DatasetWriter::Note(int64_t clip, bool done) {
  const std::lock_guard guard(mutex_);
  done_.erase(clip);
  failed_.erase(clip);
  (done ? done_ : failed_).insert(clip);
}

void DatasetWriter::Adopt(const fs::path& from, const std::vector<Json>& lines) {
  std::set<std::string> paths;  // a tar is named by all its files
  for (const Json& line : lines)
    for (const StoredFile& file : FilesOfLine(line)) paths.insert(file.path);
  std::set<fs::path> changed;
  MakeFolders(staging_);
  for (const std::string& path : paths) {
    if (!layout_.PlaceOf(path) && !layout_.UnitOfTar(path))
      throw std::runtime_error(from.string() + ": its manifest names '" + path +
                               "', which is no place for a file of such a set");
    const fs::path to = folder_ / path, beside = staging_ / "adopted";
    if (layout_.IsTars()) KeepTar(to, staging_);
    MakeFolders(to.parent_path());
    LinkOrCopy(from / path, beside);
    Rename(beside, to);
    RemoveAll(beside);  // rename does nothing where both are links to one file
    changed.insert(to.parent_path());
  }
  FileHandle(folder_, O_RDONLY | O_DIRECTORY).SyncFileSystem();
  for (const fs::path& folder : changed) SyncFolder(folder);
  lines_->Append(lines);
  if (layout_.IsTars()) DropKeptTars(staging_);
  for (const Json& line : lines)
    Note(line.at("clip").get<int64_t>(), line.at("status").get<std::string>() == "done");
}

// What earlier processes have left behind: their staging, and clips that were moved and not named. A shard,
// beside which others may be at work, clears away its own; what it can't know of is replaced, or waits for
// the merge.
void DatasetWriter::CleanUp(const Shard& shard) const {
  const std::string left = shard.whole() ? std::string(kStagingName) + "*" : staging_.filename().string();
  for (const fs::path& staging : ExpandGlob(folder_, left)) {
    SettleKeptTars(folder_, staging);
    std::error_code gone;  // by whoever waits to write here, and had a file to remember
    for (const auto& entry : fs::directory_iterator(staging, gone)) {
      const std::string name = entry.path().filename().string();
      const bool is_clip = name.size() <= 18 && name.find_first_not_of("0123456789") == std::string::npos;
      const int64_t clip = is_clip ? std::stoll(name) : -1;
      if (is_clip && !done_.contains(clip)) Remove(clip);
      RemoveAll(entry.path());
    }
    RemoveAll(staging);
  }
}

// Whatever lies under the final names of a clip.
void DatasetWriter::Remove(int64_t clip) const {
  if (layout_.IsTars()) return;  // a tar comes and goes whole
  const std::vector<std::string> folders = layout_.ClipFolders(clip);
  for (const std::string& folder : folders) RemoveAll(folder_ / folder);
  if (!folders.empty()) return;
  for (const FrameKind kind : kFrameKinds)
    for (int64_t frame = 0; frame < layout_.frames_per_clip; ++frame)
      RemoveAll(folder_ / layout_.Path(kind, clip, frame));
}

}  // namespace shimmer::dataset
