// Which files the clean frames of a data set come from: found once, byte-sorted, hashed, and recorded in
// dataset.json.
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "sim/app/config/config.h"
#include "sim/dataset/frame_reader.h"
#include "sim/dataset/hash_memory.h"
#include "sim/dataset/interrupted.h"
#include "sim/dataset/sources.h"

namespace shimmer::app {

enum class SourceKind { kImages, kVideo, kSequence, kDrawn };

class SourceList {
 public:
  // Relative patterns are looked up below config_folder, then below the working directory. What lies below
  // out, where clips go, is no source. Files are hashed on all threads, but for those that out remembers from
  // an earlier run. section: where the patterns stand in the config; hashes: shared by all lists of a run.
  // Masks go with what they are of in the order of the patterns, where each of these finds one, else by their
  // names (mask_pairs.h). Throws ConfigError where nothing matches, or where a mask has no like;
  // dataset::Interrupted once stop is set.
  static SourceList Find(const FilePatterns& patterns, const std::filesystem::path& config_folder,
                         const std::filesystem::path& out,
                         const std::atomic<bool>& stop = dataset::kNeverStop,
                         const std::string& section = "/source",
                         std::shared_ptr<dataset::HashMemory> hashes = nullptr);

  // Remembers the hashes in out, once it is a data set's folder, for the next run. Once.
  void Remember(const std::filesystem::path& out);

  SourceKind kind() const { return kind_; }
  bool still() const { return kind_ == SourceKind::kImages || kind_ == SourceKind::kDrawn; }
  const std::vector<std::filesystem::path>& items() const { return items_.paths; }  // empty for drawn scenes
  const std::vector<std::filesystem::path>& masks() const { return masks_.paths; }  // one an item, or none

  // {"path": ..., "sha256": ...}. The path is relative to the config's folder for what lies in it, else
  // absolute. The hash is of a file's bytes, or of the hashes of a sequence's frames; null for one that can't
  // be read: its clips will fail, and say why.
  const Json& Record(size_t item) const { return records_.at(item); }
  // An array, in the order of items(); after them those of masks(), with "mask_of": the item's path.
  const Json& Records() const { return records_; }

  // Pictures are read through the cache, which must outlive the reader. Throws std::runtime_error. A video's
  // frames are counted once, by decoding it, for all clips that use it.
  // Reading a video throws dataset::Interrupted once stop is set, which must outlive the reader.
  std::unique_ptr<dataset::FrameReader> Open(size_t item, dataset::PictureCache& pictures,
                                             const std::atomic<bool>& stop = dataset::kNeverStop) const {
    return OpenOne(items_, item, pictures, stop);
  }
  // The masks of an item; as many frames as it has itself, or this throws.
  std::unique_ptr<dataset::FrameReader> OpenMasks(size_t item, dataset::PictureCache& pictures,
                                                  const std::atomic<bool>& stop = dataset::kNeverStop) const;

  // What is odd about a video that has been opened; empty if nothing.
  std::string Remark(size_t item) const;

 private:
  struct VideoFacts {
    std::mutex mutex;  // whoever asks while they are being found waits
    std::optional<int64_t> frames;
    std::string remark;
  };
  struct Files {
    std::vector<std::filesystem::path> paths;
    std::unique_ptr<std::vector<VideoFacts>> videos;  // of each, where they are videos
  };

  std::unique_ptr<dataset::FrameReader> OpenOne(const Files& files, size_t item,
                                                dataset::PictureCache& pictures,
                                                const std::atomic<bool>& stop) const;

  SourceKind kind_ = SourceKind::kDrawn;
  std::string section_;
  Files items_, masks_;
  Json records_ = Json::array();
  std::shared_ptr<dataset::HashMemory> hashes_;  // until they are remembered
};

}  // namespace shimmer::app
