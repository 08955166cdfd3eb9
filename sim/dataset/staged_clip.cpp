#include "sim/dataset/staged_clip.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sim/dataset/sha256.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

bool StaysInside(const fs::path& path) {
  return !path.empty() && path.is_relative() && std::ranges::count(path, fs::path("..")) == 0;
}

}  // namespace

StagedClip::StagedClip(const fs::path& staging, int64_t clip, bool bundled)
    : clip_(clip), bundled_(bundled), folder_(staging / std::to_string(clip)) {}

StagedClip::~StagedClip() {
  try {
    Remove();
  } catch (const std::exception&) {
    // Opening the data set again cleans up.
  }
}

StagedClip::StagedClip(StagedClip&& other) noexcept
    : clip_(other.clip_),
      bundled_(other.bundled_),
      folder_(std::exchange(other.folder_, {})),
      files_(std::move(other.files_)) {}

StagedClip& StagedClip::operator=(StagedClip&& other) noexcept {
  std::swap(clip_, other.clip_);
  std::swap(bundled_, other.bundled_);
  std::swap(folder_, other.folder_);
  std::swap(files_, other.files_);
  return *this;
}

void StagedClip::Add(const ClipFile& file) {
  if (!StaysInside(file.path))
    throw std::invalid_argument("'" + file.path + "' is no place for a file of clip " +
                                std::to_string(clip_));
  const fs::path place = PlaceOf(file.path);
  try {
    fs::create_directories(place.parent_path());
    if (bundled_ && !files_.empty())
      AppendUnsynced(place, file.bytes);
    else
      WriteUnsynced(place, file.bytes);
  } catch (const fs::filesystem_error& error) {
    throw TargetError(error.path1().string() + ": can't be made: " + error.code().message());
  } catch (const std::runtime_error& error) {
    throw TargetError(error.what());
  }
  const int64_t end = files_.empty() ? 0 : files_.back().offset + files_.back().bytes;
  StoredFile& stored = files_.emplace_back();
  if (bundled_) stored.offset = end;
  stored.path = file.path;
  stored.bytes = static_cast<int64_t>(file.bytes.size());
  stored.sha256 = Sha256Hex(file.bytes);
  stored.pixels = file.pixel_hash;
}

fs::path StagedClip::PlaceOf(const std::string& path) const { return folder_ / (bundled_ ? "bundle" : path); }

void StagedClip::Remove() {
  if (!folder_.empty()) RemoveAll(folder_);
}

}  // namespace shimmer::dataset
