// Reads a data set of any layout by what its manifest names, also while it is being written.
// Throws std::runtime_error for what is missing or damaged, with its path, std::invalid_argument for a clip
// or frame that is not in the data set.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim/dataset/image_io.h"
#include "sim/dataset/manifest.h"

namespace shimmer::dataset {

// By frame. clean has one where all clean frames are the same.
struct ClipFiles {
  std::vector<StoredFile> turb, clean, truth;
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

 private:
  Picture Read(const StoredFile& file) const;
  std::optional<cv::Mat> Truth(int64_t clip, int64_t frame, std::span<const std::string> channels) const;

  std::filesystem::path folder_;
  Json description_;
  Manifest manifest_;
};

}  // namespace shimmer::dataset
