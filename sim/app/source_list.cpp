#include "sim/app/source_list.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "sim/dataset/files.h"
#include "sim/dataset/sha256.h"

namespace shimmer::app {
namespace {

namespace fs = std::filesystem;

// One hash for all frames of a sequence: of their hashes, in order.
std::string HashOfSequence(const fs::path& sequence, dataset::HashMemory& memory,
                           const std::atomic<bool>& stop) {
  const std::vector<fs::path> frames = dataset::SequenceFiles(sequence);
  std::vector<std::string> hashes(frames.size());
  tbb::parallel_for(size_t{0}, frames.size(), [&](size_t i) { hashes[i] = memory.HashOf(frames[i], stop); });
  std::string all;
  for (const std::string& hash : hashes) all += hash;
  return dataset::Sha256Hex(dataset::AsBytes(all));
}

// Of every item, on all threads; null where it can't be read.
std::vector<Json> HashesOf(const std::vector<fs::path>& items, SourceKind kind, dataset::HashMemory& memory,
                           const std::atomic<bool>& stop) {
  std::vector<Json> hashes(items.size());
  tbb::parallel_for(size_t{0}, items.size(), [&](size_t i) {
    if (stop) return;
    try {
      hashes[i] = kind == SourceKind::kSequence ? HashOfSequence(items[i], memory, stop)
                                                : memory.HashOf(items[i], stop);
    } catch (const std::runtime_error&) {
      // null
    }
  });
  if (stop) throw dataset::Interrupted();
  return hashes;
}

// JSON is UTF-8, names of files needn't be.
Json AsJson(const std::string& name) {
  return Json::parse(Json(name).dump(-1, ' ', false, Json::error_handler_t::replace));
}

fs::path FolderPlace(const fs::path& folder) { return fs::weakly_canonical(folder.empty() ? "." : folder); }

// One spelling for each place, whatever links lead to its folder. (A link that is itself a source stays one.)
class Places {
 public:
  fs::path Of(const fs::path& path) {
    const fs::path absolute = fs::absolute(path.empty() ? "." : path).lexically_normal();
    const fs::path whole = absolute.has_filename() ? absolute : absolute.parent_path();
    const auto [folder, is_new] = folders_.try_emplace(whole.parent_path().native());
    if (is_new) folder->second = fs::weakly_canonical(whole.parent_path());
    return folder->second / whole.filename();
  }

 private:
  std::map<std::string, fs::path> folders_;  // looked up once each: there are many files in few folders
};

// Relative to the folder where the place lies in it, else empty.
fs::path Within(const fs::path& folder, const fs::path& place) {
  const fs::path from_folder = place.lexically_relative(folder);
  return from_folder.empty() || *from_folder.begin() == ".." ? fs::path() : from_folder;
}

}  // namespace

SourceList SourceList::Find(const SourceParams& source, const fs::path& config_folder, const fs::path& out,
                            const std::atomic<bool>& stop) {
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
  // Named relative to the config's folder for what lies in it, else absolute: the same from whatever folder
  // the command is given, and wherever config and pictures are moved together.
  Places places;
  const fs::path out_place = FolderPlace(out), config_place = FolderPlace(config_folder);
  std::vector<std::pair<std::string, fs::path>> named;
  for (const fs::path& item : list.items_) {
    const fs::path place = places.Of(item), within = Within(config_place, place);
    if (Within(out_place, place).empty()) named.emplace_back(within.empty() ? place : within, item);
  }
  if (named.empty()) throw ConfigError(key, "finds nothing but what lies in --out " + out.string());
  // By the bytes of the name, each name once: which source a clip takes hangs on the order.
  std::ranges::sort(named);
  const auto repeats = std::ranges::unique(named, {}, &std::pair<std::string, fs::path>::first);
  named.erase(repeats.begin(), repeats.end());
  list.items_.clear();
  for (const auto& [name, item] : named) list.items_.push_back(item);
  if (list.kind_ == SourceKind::kVideo)
    list.videos_ = std::make_unique<std::vector<VideoFacts>>(list.items_.size());
  list.hashes_ = std::make_shared<dataset::HashMemory>(out);
  const std::vector<Json> hashes = HashesOf(list.items_, list.kind_, *list.hashes_, stop);
  for (size_t i = 0; i < named.size(); ++i)
    list.records_.push_back({{"path", AsJson(named[i].first)}, {"sha256", hashes[i]}});
  return list;
}

void SourceList::Remember(const fs::path& out) {
  if (hashes_) hashes_->Write(out);
  hashes_.reset();
}

std::unique_ptr<dataset::FrameReader> SourceList::Open(size_t item, dataset::PictureCache& pictures,
                                                       const std::atomic<bool>& stop) const {
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
  VideoFacts& facts = videos_->at(item);
  const std::lock_guard guard(facts.mutex);
  auto reader = dataset::OpenVideo(items_.at(item), facts.frames, stop);
  if (!facts.frames) facts.frames = reader->count(), facts.remark = reader->remark();
  return reader;
}

std::string SourceList::Remark(size_t item) const {
  if (!videos_) return "";
  VideoFacts& facts = videos_->at(item);
  const std::lock_guard guard(facts.mutex);
  return facts.remark;
}

}  // namespace shimmer::app
