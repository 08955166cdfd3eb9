#include "sim/app/source_list.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "sim/app/mask_pairs.h"
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

std::vector<fs::path> FindKind(SourceKind kind, const std::string& pattern, std::span<const fs::path> bases) {
  const std::span<const std::string> patterns(&pattern, 1);
  if (kind == SourceKind::kSequence) return dataset::FindSequences(patterns, bases);
  return dataset::FindFiles(
      patterns, bases, kind == SourceKind::kImages ? dataset::FileKind::kPicture : dataset::FileKind::kVideo);
}

// What the patterns of a key mean.
struct FoundFiles {
  std::vector<Named> files;
  std::vector<size_t> listed;  // of each pattern its file; empty unless each finds one, and another one
};

FoundFiles FindAll(SourceKind kind, const std::vector<std::string>& patterns, const std::string& pointer,
                   const fs::path& config_folder, const fs::path& out) {
  const fs::path bases[] = {config_folder, ""};
  std::vector<fs::path> all;
  bool one_each = true;
  for (const std::string& pattern : patterns) {
    try {
      const std::vector<fs::path> found = FindKind(kind, pattern, bases);
      one_each &= found.size() == 1;
      all.insert(all.end(), found.begin(), found.end());
    } catch (const std::runtime_error& error) {
      throw ConfigError(pointer, error.what());
    }
  }
  FoundFiles found{WithNames(all, config_folder, out), {}};
  if (found.files.empty()) throw ConfigError(pointer, "finds nothing but what lies in --out " + out.string());
  if (one_each && found.files.size() == patterns.size())
    for (const fs::path& path : all)
      found.listed.push_back(
          static_cast<size_t>(std::ranges::find(found.files, path, &Named::second) - found.files.begin()));
  return found;
}

// For each item the index of its mask: as listed, or by the names.
std::vector<size_t> PairsOf(const FoundFiles& items, const FoundFiles& masks) {
  if (!items.listed.empty() && items.listed.size() == masks.listed.size()) {
    std::vector<size_t> pairs(items.listed.size());
    for (size_t i = 0; i < pairs.size(); ++i) pairs[items.listed[i]] = masks.listed[i];
    return pairs;
  }
  const auto names_of = [](const FoundFiles& found) {
    std::vector<std::string> names;
    for (const Named& file : found.files) names.push_back(file.first);
    return names;
  };
  return PairMasks(names_of(items), names_of(masks));
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
  const auto add = [&](const std::vector<Named>& named, Files& files) {
    for (const auto& [name, path] : named) files.paths.push_back(path);
    if (list.kind_ == SourceKind::kVideo)
      files.videos = std::make_unique<std::vector<VideoFacts>>(files.paths.size());
    const std::vector<Json> sha256 = HashesOf(files.paths, list.kind_, *list.hashes_, stop);
    for (size_t i = 0; i < named.size(); ++i)
      list.records_.push_back({{"path", AsJson(named[i].first)}, {"sha256", sha256[i]}});
  };
  const FoundFiles items = FindAll(list.kind_, *wanted, key, config_folder, out);
  add(items.files, list.items_);
  if (patterns.masks.empty()) return list;
  const std::string masks_key = section + "/masks";
  const FoundFiles masks = FindAll(list.kind_, patterns.masks, masks_key, config_folder, out);
  std::vector<Named> paired;
  try {
    for (const size_t mask : PairsOf(items, masks)) paired.push_back(masks.files[mask]);
  } catch (const std::invalid_argument& error) {
    throw ConfigError(masks_key, error.what() + std::string(" (") + key + ")");
  }
  add(paired, list.masks_);
  for (size_t i = 0; i < paired.size(); ++i)
    list.records_[paired.size() + i]["mask_of"] = list.records_[i]["path"];
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
