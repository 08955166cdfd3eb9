// A data set to be made: its config, its sources, and what follows from them for each clip.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "sim/app/config/config.h"
#include "sim/app/cutout_memory.h"
#include "sim/app/source_list.h"
#include "sim/dataset/interrupted.h"
#include "sim/dataset/layout.h"
#include "sim/dataset/picture_cache.h"
#include "sim/plan.h"

namespace shimmer::app {

// Grows by one whenever the pixels of an existing config change.
inline constexpr int kEngine = 5;
inline constexpr const char* kVersion = "shimmer 0.1.0";

// Throws ConfigError, or std::invalid_argument if the file can't be read.
ConfigFile LoadConfig(const std::filesystem::path& path, std::span<const std::string> sets);

// The config of a data set, and where its files lie, by what its dataset.json says. Throws std::runtime_error
// where that is damaged: a data set is no argument of the person's.
ConfigFile ConfigOfDataset(const std::filesystem::path& folder, const Json& description);
dataset::Layout LayoutOfDataset(const std::filesystem::path& folder, const Json& description);

// Where the files of a config's clips lie.
dataset::Layout LayoutOfConfig(const ConfigFile& config);

// Of decoded pictures, unless told otherwise (PictureCache::SetBudget).
inline constexpr uint64_t kPictureCacheBytes = 512 << 20;

// Of cut-outs that are kept; beside the decoded pictures (clip_size.h).
inline constexpr int64_t kCutoutMemory_bytes = int64_t{128} << 20;

struct Job {
  ConfigFile config;
  SourceList sources;
  std::vector<SourceList> object_sources;  // of each of config.objects; of kind kDrawn where it is drawn
  std::unique_ptr<dataset::PictureCache> pictures =
      std::make_unique<dataset::PictureCache>(kPictureCacheBytes);  // that sources are read through
  std::unique_ptr<CutoutMemory> cutouts = std::make_unique<CutoutMemory>(kCutoutMemory_bytes);

  // Reads the config file, applies the overrides, finds and hashes the sources (none below out, where clips
  // go). Throws as LoadConfig, ConfigError where a source pattern matches nothing, and dataset::Interrupted
  // once stop is set.
  static Job Load(const std::filesystem::path& config_path, std::span<const std::string> sets,
                  const std::filesystem::path& out, const std::atomic<bool>& stop = dataset::kNeverStop);

  // Of a data set, to make clips of it again: the config that its dataset.json holds, and the sources that it
  // finds now, relative ones from config_folder. Throws std::runtime_error where there are none, and where
  // this would make another data set (each difference is named); dataset::Interrupted once stop is set.
  static Job OfDataset(const std::filesystem::path& folder, const Json& description,
                       const std::filesystem::path& config_folder,
                       const std::atomic<bool>& stop = dataset::kNeverStop);

  // Remembers the hashes of all of them, once out is a data set's folder.
  void RememberSources(const std::filesystem::path& out);
  bool FromFiles() const;  // any of them

  // What dataset.json says: config, its hash, sources with hashes, engine, version.
  Json Description() const;
  dataset::Layout Layout() const;
};

// How many of a clip's frames are rendered and kept: all, or for pairs and
// restormer frames_per_clip of them.
int KeptFrameCount(const Config& config);

// frames: those that are kept.
sim::ClipShape ShapeOf(const Config& config);

// The scene that a clip's values mean, and its plan.
sim::Scene SceneOf(const Config& config, bool still);
sim::ClipPlan PlanOf(const Config& config, bool still);

}  // namespace shimmer::app
