// Clips as an evaluation takes them: turbulent frames, and what is known to be true of them.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "restore/app/evaluation/results.h"

namespace shimmer::restore::app {

// Frames 0 .. facts().frames - 1. For one thread at a time. Reading throws std::runtime_error.
class TrueClip {
 public:
  virtual ~TrueClip() = default;
  virtual const ClipFacts& facts() const = 0;
  virtual cv::Mat Turb(int64_t frame) = 0;  // as levels.h takes frames

  // Absent where it is not known. The clean frame and the mask (CV_8UC1, 255 where something moves) are of
  // the steady camera; the shake is steady(p) = turb(p + s), in px.
  virtual std::optional<cv::Mat> Clean(int64_t frame) = 0;
  virtual std::optional<cv::Mat> Mask(int64_t frame) = 0;
  virtual std::optional<cv::Point2d> Shake(int64_t frame) = 0;

  // px along each side that do not count.
  virtual int margin_px() const { return 0; }
};

// The clips of a data set.
class ClipSet {
 public:
  virtual ~ClipSet() = default;
  virtual const std::vector<std::string>& names() const = 0;  // of those that are there, in order
  virtual int64_t count() const = 0;                          // of the set, with those that are not there
  // For any number of threads at a time. Throws std::runtime_error.
  virtual std::unique_ptr<TrueClip> Open(size_t clip) const = 0;
  // What tells the set from others, wherever it lies.
  virtual nlohmann::json Identity() const = 0;
};

// A data set of shimmer's. Throws std::runtime_error where it is none, and std::invalid_argument where its
// truth is too little to evaluate by: a camera that shakes whose shake was not written.
std::unique_ptr<ClipSet> OpenDataset(const std::filesystem::path& folder);

// Files of others in a folder, as an adapter names them (adapter_clips.cpp, docs/evaluation.md). Throws
// std::invalid_argument for what is wrong with the adapter, with its file and key, or where the folder has no
// such clips.
std::unique_ptr<ClipSet> OpenWithAdapter(const std::filesystem::path& folder,
                                         const std::filesystem::path& adapter, const std::atomic<bool>& stop);

// Videos of which nothing is known; each as OpenFrames takes them. Throws as it does.
std::unique_ptr<ClipSet> OpenRealVideos(const std::vector<std::filesystem::path>& videos,
                                        const std::atomic<bool>& stop);

}  // namespace shimmer::restore::app
