#include "sim/dataset/dataset_writer.h"

#include <algorithm>
#include <stdexcept>

#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/sha256.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

bool StaysInside(const fs::path& path) {
  return !path.empty() && path.is_relative() && std::ranges::count(path, fs::path("..")) == 0;
}

std::set<fs::path> Parents(std::span<const fs::path> paths) {
  std::set<fs::path> parents;
  for (const fs::path& path : paths) parents.insert(path.parent_path());
  return parents;
}

}  // namespace

DatasetWriter::DatasetWriter(fs::path folder, Layout layout, const Json& description)
    : folder_(std::move(folder)),
      layout_(std::move(layout)),
      lock_((layout_.Validate(), MakeAndLockFolder(folder_))) {
  WriteDescription(folder_, description);
  const Manifest manifest(folder_ / kManifestName);
  done_ = manifest.done();
  failed_ = manifest.failed();
  manifest_.emplace(folder_ / kManifestName, manifest.whole_bytes());
  CleanStaging();
}

DatasetWriter::~DatasetWriter() {
  std::error_code ignored;
  fs::remove(folder_ / kStagingName, ignored);  // which does nothing to a folder that is not empty
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

void DatasetWriter::Commit(int64_t clip, std::span<const ClipFile> files, Json line) {
  if (clip < 0 || IsDone(clip))
    throw std::invalid_argument("clip " + std::to_string(clip) + " is done already or no clip");
  const std::string clip_folder = layout_.ClipFolder(clip);
  for (const ClipFile& file : files)
    if (!StaysInside(file.path) || (!clip_folder.empty() && !file.path.starts_with(clip_folder + "/")))
      throw std::invalid_argument("'" + file.path + "' is no place for a file of clip " +
                                  std::to_string(clip));

  line["files"] = Json::array();
  for (const ClipFile& file : files) {
    Json entry = {{"path", file.path}, {"sha256", Sha256Hex(file.bytes)}};
    if (!file.pixel_hash.empty()) entry["pixels"] = file.pixel_hash;
    line["files"].push_back(std::move(entry));
  }
  try {
    Stage(clip, files);
    Publish(clip, files);
    Append(clip, "done", std::move(line));
    RemoveAll(StagingOf(clip));
  } catch (...) {
    try {
      if (!IsDone(clip)) Remove(clip);
      RemoveAll(StagingOf(clip));
    } catch (const std::exception&) {
      // The first error is the one to tell; opening the folder again cleans up.
    }
    throw;
  }
}

void DatasetWriter::Fail(int64_t clip, Json line) {
  Remove(clip);
  Append(clip, "failed", std::move(line));
}

fs::path DatasetWriter::StagingOf(int64_t clip) const {
  return folder_ / kStagingName / std::to_string(clip);
}

// Staging of a sequence is the clip's folder itself, to be renamed; of pairs, a tree as in the data set's
// folder.
fs::path DatasetWriter::NameInStaging(int64_t clip, const std::string& path) const {
  const std::string clip_folder = layout_.ClipFolder(clip);
  return StagingOf(clip) / (clip_folder.empty() ? path : path.substr(clip_folder.size() + 1));
}

void DatasetWriter::CleanStaging() const {
  const fs::path staging = folder_ / kStagingName;
  if (!fs::exists(staging)) return;
  for (const auto& entry : fs::directory_iterator(staging)) {
    const std::string name = entry.path().filename().string();
    const bool clip_name = name.size() <= 18 && name.find_first_not_of("0123456789") == std::string::npos;
    if (clip_name && !done_.contains(std::stoll(name))) Remove(std::stoll(name));
  }
  RemoveAll(staging);
}

void DatasetWriter::Stage(int64_t clip, std::span<const ClipFile> files) const {
  const fs::path staging = StagingOf(clip);
  RemoveAll(staging);
  MakeFolders(staging);
  std::vector<fs::path> names;
  std::vector<FileToWrite> to_write;
  for (const ClipFile& file : files) {
    names.push_back(NameInStaging(clip, file.path));
    to_write.push_back({names.back(), file.bytes});
  }
  std::set<fs::path> folders = Parents(names);
  for (const fs::path& folder : folders) fs::create_directories(folder);
  WriteFiles(to_write);
  folders.insert(staging);
  for (const fs::path& folder : folders) SyncFolder(folder);
}

void DatasetWriter::Publish(int64_t clip, std::span<const ClipFile> files) const {
  const std::string clip_folder = layout_.ClipFolder(clip);
  if (!clip_folder.empty()) {
    const fs::path final_folder = folder_ / clip_folder;
    MakeFolders(final_folder.parent_path());
    // There may be one from a kill between this rename and the manifest; out of the way it goes.
    RemoveAll(final_folder);
    Rename(StagingOf(clip), final_folder);
    SyncFolder(final_folder.parent_path());
    return;
  }
  std::vector<fs::path> final_paths;
  for (const ClipFile& file : files) {
    final_paths.push_back(folder_ / file.path);
    MakeFolders(final_paths.back().parent_path());
    Rename(NameInStaging(clip, file.path), final_paths.back());
  }
  for (const fs::path& parent : Parents(final_paths)) SyncFolder(parent);
}

// Whatever lies under the final names of a clip.
void DatasetWriter::Remove(int64_t clip) const {
  const std::string clip_folder = layout_.ClipFolder(clip);
  if (!clip_folder.empty()) return RemoveAll(folder_ / clip_folder);
  for (const FrameKind kind : {FrameKind::kTurb, FrameKind::kClean, FrameKind::kTruth})
    for (int64_t frame = 0; frame < layout_.frames_per_clip; ++frame)
      RemoveAll(folder_ / layout_.Path(kind, clip, frame));
}

void DatasetWriter::Append(int64_t clip, const char* status, Json line) {
  line["clip"] = static_cast<uint64_t>(clip);
  line["status"] = status;
  const std::lock_guard guard(mutex_);
  manifest_->Append(line);
  done_.erase(clip);
  failed_.erase(clip);
  (status == std::string("done") ? done_ : failed_).insert(clip);
}

}  // namespace shimmer::dataset
