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

using Named = std::pair<std::string, fs::path>;

// Named relative to the config's folder for what lies in it, else absolute: the same from whatever folder the
// command is given, and wherever config and pictures are moved together. By the bytes of the name, each name
// once: which source a clip takes hangs on the order. Without what lies in out.
std::vector<Named> WithNames(const std::vector<fs::path>& paths, const fs::path& config_folder,
                             const fs::path& out) {
  Places places;
  const fs::path out_place = FolderPlace(out), config_place = FolderPlace(config_folder);
  std::vector<Named> named;
  for (const fs::path& path : paths) {
    const fs::path place = places.Of(path), within = Within(config_place, place);
    if (Within(out_place, place).empty()) named.emplace_back(within.empty() ? place : within, path);
  }
  std::ranges::sort(named);
  const auto repeats = std::ranges::unique(named, {}, &Named::first);
  named.erase(repeats.begin(), repeats.end());
  return named;
}

std::vector<fs::path> FindKind(SourceKind kind, std::span<const std::string> patterns,
                               std::span<const fs::path> bases) {
  if (kind == SourceKind::kSequence) return dataset::FindSequences(patterns, bases);
  return dataset::FindFiles(
      patterns, bases, kind == SourceKind::kImages ? dataset::FileKind::kPicture : dataset::FileKind::kVideo);
}

}  // namespace

SourceList SourceList::Find(const FilePatterns& patterns, const fs::path& config_folder, const fs::path& out,
                            const std::atomic<bool>& stop, const std::string& section,
                            std::shared_ptr<dataset::HashMemory> hashes) {
  SourceList list;
  list.section_ = section;
  const std::vector<std::string>* wanted = nullptr;
  std::string key;
  if (!patterns.images.empty())
    list.kind_ = SourceKind::kImages, wanted = &patterns.images, key = section + "/images";
  else if (!patterns.video.empty())
    list.kind_ = SourceKind::kVideo, wanted = &patterns.video, key = section + "/video";
  else if (!patterns.sequence.empty())
    list.kind_ = SourceKind::kSequence, wanted = &patterns.sequence, key = section + "/sequence";
  else
    return list;
  list.hashes_ = hashes ? std::move(hashes) : std::make_shared<dataset::HashMemory>(out);
  const fs::path bases[] = {config_folder, ""};
  // Finds, names and hashes what the patterns of a key mean.
  const auto add = [&](const std::vector<std::string>& of_key, const std::string& pointer, Files& files) {
    std::vector<fs::path> found;
    try {
      found = FindKind(list.kind_, of_key, bases);
    } catch (const std::runtime_error& error) {
      throw ConfigError(pointer, error.what());
    }
    const std::vector<Named> named = WithNames(found, config_folder, out);
    if (named.empty()) throw ConfigError(pointer, "finds nothing but what lies in --out " + out.string());
    for (const auto& [name, path] : named) files.paths.push_back(path);
    if (list.kind_ == SourceKind::kVideo)
      files.videos = std::make_unique<std::vector<VideoFacts>>(files.paths.size());
    const std::vector<Json> sha256 = HashesOf(files.paths, list.kind_, *list.hashes_, stop);
    for (size_t i = 0; i < named.size(); ++i)
      list.records_.push_back({{"path", AsJson(named[i].first)}, {"sha256", sha256[i]}});
  };
  add(*wanted, key, list.items_);
  if (patterns.masks.empty()) return list;
  const size_t items = list.items_.paths.size();
  add(patterns.masks, section + "/masks", list.masks_);
  if (list.masks_.paths.size() != items)
    throw ConfigError(section + "/masks", "finds " + std::to_string(list.masks_.paths.size()) +
                                              ", must find one for each of the " + std::to_string(items) +
                                              " of " + key);
  for (size_t i = 0; i < items; ++i) list.records_[items + i]["mask_of"] = list.records_[i]["path"];
  return list;
}

void SourceList::Remember(const fs::path& out) {
  if (hashes_) hashes_->Write(out);
  hashes_.reset();
}

std::unique_ptr<dataset::FrameReader> SourceList::OpenOne(const Files& files, size_t item,
                                                          dataset::PictureCache& pictures,
                                                          const std::atomic<bool>& stop) const {
  const fs::path& path = files.paths.at(item);
  switch (kind_) {
    case SourceKind::kImages:
      return dataset::OpenStill(path, &pictures);
    case SourceKind::kSequence:
      return dataset::OpenSequence(path, &pictures);
    case SourceKind::kDrawn:
      throw std::logic_error("a drawn scene has no file to open");
    case SourceKind::kVideo:
      break;
  }
  VideoFacts& facts = files.videos->at(item);
  const std::lock_guard guard(facts.mutex);
  auto reader = dataset::OpenVideo(path, facts.frames, stop);
  if (!facts.frames) facts.frames = reader->count(), facts.remark = reader->remark();
  return reader;
}

std::unique_ptr<dataset::FrameReader> SourceList::OpenMasks(size_t item, dataset::PictureCache& pictures,
                                                            const std::atomic<bool>& stop) const {
  auto masks = OpenOne(masks_, item, pictures, stop);
  const int64_t frames = Open(item, pictures, stop)->count();
  if (masks->count() != frames)
    throw std::runtime_error(section_ + "/masks: " + masks_.paths[item].string() + " has " +
                             std::to_string(masks->count()) + " frames, must have " + std::to_string(frames) +
                             " as " + items_.paths[item].string());
  return masks;
}

std::string SourceList::Remark(size_t item) const {
  if (!items_.videos) return "";
  VideoFacts& facts = items_.videos->at(item);
  const std::lock_guard guard(facts.mutex);
  return facts.remark;
}

}  // namespace shimmer::app
