// Reads a data set of any layout by what its manifest names, also while it is being written.
// Throws std::runtime_error for what is missing or damaged, with its path, std::invalid_argument for a clip
// or frame that is not in the data set.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim/dataset/image_io.h"
#include "sim/dataset/manifest.h"

namespace shimmer::dataset {

inline constexpr std::array<const char*, 2> kFlowChannels = {"u", "v"};
inline constexpr const char* kShakeKey = "shifts_px";  // of shake.json: [[x, y], ...], one a frame

// By frame. clean has one where all clean frames are the same, flow one fewer than there are frames, shake
// one; those that were not written are empty.
struct ClipFiles {
  std::vector<StoredFile> turb, clean, truth, mask, flow, shake;
};

class DatasetReader {
 public:
  // damaged: Manifest's.
  explicit DatasetReader(std::filesystem::path folder, const Manifest::Damaged& damaged = {});

  const Json& description() const { return description_; }  // dataset.json
  const std::set<int64_t>& clips() const { return manifest_.done(); }
  const std::set<int64_t>& failed() const { return manifest_.failed(); }

  const std::filesystem::path& folder() const { return folder_; }
  const Manifest& manifest() const { return manifest_; }
  Json Line(int64_t clip) const { return manifest_.Line(clip); }  // of the manifest, failed clips' too
  ClipFiles Files(int64_t clip) const;
  int64_t FrameCount(int64_t clip) const;

  std::vector<uint8_t> Bytes(const StoredFile& file) const;  // as they are, whole or not
  Picture Turb(int64_t clip, int64_t frame) const;
  Picture Clean(int64_t clip, int64_t frame) const;
  std::optional<cv::Mat> TruthTilt(int64_t clip,
                                   int64_t frame) const;  // CV_32FC2: dx, dy in px; absent if not written
  std::optional<cv::Mat> TruthSigma(int64_t clip,
                                    int64_t frame) const;  // CV_32FC1, px; absent if not written

  // Of the steady frame, its camera's shake removed: how much of each pixel moving objects cover, CV_32FC1 in
  // [0, 1]; where what is seen there is in the next frame, CV_32FC2 (u, v) in px. Absent if not written, the
  // flow for the last frame too.
  std::optional<cv::Mat> TruthMask(int64_t clip, int64_t frame) const;
  std::optional<cv::Mat> TruthFlow(int64_t clip, int64_t frame) const;

  // s of each frame, px: steady(p) = shaken(p + s). Absent if not written.
  std::optional<std::vector<cv::Point2d>> TruthShake(int64_t clip) const;

 private:
  Picture Read(const StoredFile& file) const;
  std::optional<cv::Mat> Channels(const StoredFile& file, std::span<const std::string> channels) const;
  std::optional<cv::Mat> Truth(int64_t clip, int64_t frame, std::span<const std::string> channels) const;

  std::filesystem::path folder_;
  Json description_;
  Manifest manifest_;
};

}  // namespace shimmer::dataset
