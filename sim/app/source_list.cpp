#include "sim/app/source_list.h"

#include <algorithm>
#include <utility>

#include "sim/dataset/files.h"
#include "sim/dataset/frame_reader.h"
#include "sim/dataset/sha256.h"

namespace shimmer::app {
namespace {

namespace fs = std::filesystem;

std::string HashOfFile(const fs::path& file) {
  dataset::RequireFile(file);  // a pipe would be waited for
  return dataset::Sha256HexOfFile(file);
}

// One hash for all frames of a sequence: of their hashes, in order.
std::string HashOfSequence(const fs::path& sequence) {
  std::string hashes;
  for (const auto& frame : dataset::SequenceFiles(sequence)) hashes += HashOfFile(frame);
  return dataset::Sha256Hex(dataset::AsBytes(hashes));
}

Json RecordOf(const fs::path& item, const std::string& name, SourceKind kind) {
  // JSON is UTF-8, names of files needn't be.
  const std::string path = Json(name).dump(-1, ' ', false, Json::error_handler_t::replace);
  Json hash;
  try {
    hash = kind == SourceKind::kSequence ? HashOfSequence(item) : HashOfFile(item);
  } catch (const std::runtime_error&) {
    // null
  }
  return {{"path", Json::parse(path)}, {"sha256", hash}};
}

// One spelling for each place, whatever links lead to its folder. (A link that is itself a source stays one.)
fs::path Place(const fs::path& path) {
  const fs::path absolute = fs::absolute(path.empty() ? "." : path).lexically_normal();
  const fs::path whole = absolute.has_filename() ? absolute : absolute.parent_path();
  return fs::weakly_canonical(whole.parent_path()) / whole.filename();
}

fs::path FolderPlace(const fs::path& folder) { return fs::weakly_canonical(folder.empty() ? "." : folder); }

bool LiesIn(const fs::path& folder, const fs::path& item) {
  const fs::path from_folder = Place(item).lexically_relative(FolderPlace(folder));
  return !from_folder.empty() && *from_folder.begin() != "..";
}

// Relative to the config's folder for what lies in it, else absolute: the same from whatever folder the
// command is given, and wherever config and pictures are moved together.
std::string NameOf(const fs::path& item, const fs::path& config_folder) {
  const fs::path place = Place(item);
  return LiesIn(config_folder, item) ? place.lexically_relative(FolderPlace(config_folder)) : place;
}

}  // namespace

SourceList SourceList::Find(const SourceParams& source, const fs::path& config_folder, const fs::path& out) {
  const fs::path bases[] = {config_folder, ""};
  SourceList list;
  const char* key = "";
  try {
    if (!source.images.empty()) {
      list.kind_ = SourceKind::kImages, key = "/source/images";
      list.items_ = dataset::FindFiles(source.images, bases, dataset::FileKind::kPicture);
    } else if (!source.video.empty()) {
      list.kind_ = SourceKind::kVideo, key = "/source/video";
      list.items_ = dataset::FindFiles(source.video, bases, dataset::FileKind::kVideo);
    } else if (!source.sequence.empty()) {
      list.kind_ = SourceKind::kSequence, key = "/source/sequence";
      list.items_ = dataset::FindSequences(source.sequence, bases);
    } else {
      return list;
    }
  } catch (const std::runtime_error& error) {
    throw ConfigError(key, error.what());
  }
  std::vector<std::pair<std::string, fs::path>> named;
  for (const fs::path& item : list.items_)
    if (!LiesIn(out, item)) named.emplace_back(NameOf(item, config_folder), item);
  if (named.empty()) throw ConfigError(key, "finds nothing but what lies in --out " + out.string());
  // By the bytes of the name, each name once: which source a clip takes hangs on the order.
  std::ranges::sort(named);
  const auto repeats = std::ranges::unique(named, {}, &std::pair<std::string, fs::path>::first);
  named.erase(repeats.begin(), repeats.end());
  list.items_.clear();
  for (const auto& [name, item] : named) {
    list.items_.push_back(item);
    list.records_.push_back(RecordOf(item, name, list.kind_));
  }
  return list;
}

std::unique_ptr<dataset::FrameReader> SourceList::Open(size_t item, dataset::PictureCache& pictures) const {
  switch (kind_) {
    case SourceKind::kImages:
      return dataset::OpenStill(items_.at(item), &pictures);
    case SourceKind::kSequence:
      return dataset::OpenSequence(items_.at(item), &pictures);
    case SourceKind::kDrawn:
      throw std::logic_error("a drawn scene has no file to open");
    case SourceKind::kVideo:
      break;
  }
  const std::lock_guard guard(videos_->mutex);
  const auto known = videos_->of_item.find(item);
  if (known != videos_->of_item.end()) return dataset::OpenVideo(items_.at(item), known->second.frames);
  auto reader = dataset::OpenVideo(items_.at(item));
  const int64_t frames = reader->count();
  videos_->of_item[item] = {frames, reader->remark()};
  return reader;
}

std::string SourceList::Remark(size_t item) const {
  const std::lock_guard guard(videos_->mutex);
  const auto known = videos_->of_item.find(item);
  return known == videos_->of_item.end() ? "" : known->second.remark;
}

}  // namespace shimmer::app
