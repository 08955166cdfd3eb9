// A clip on its way: its files are written beside, where nobody takes them for the data set's, one by one as
// they are made.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/dataset/manifest.h"

namespace shimmer::dataset {

struct ClipFile {
  std::string path;  // relative to the data set's folder, as Layout::Path gives it
  std::vector<uint8_t> bytes;
  std::string pixel_hash;  // pixel_hash.h; empty for what is no picture
};

// The target can't be written: full, gone, not permitted. No fault of the clip that met it.
struct TargetError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class StagedClip {
 public:
  // Lies in staging / "CLIP", as a tree of its own; bundled, for what goes into a tar, as one file: a file
  // system takes its time for each new one.
  StagedClip(const std::filesystem::path& staging, int64_t clip, bool bundled);
  ~StagedClip();  // takes its files away, unless they were moved to the data set
  StagedClip(StagedClip&& other) noexcept;
  StagedClip& operator=(StagedClip&& other) noexcept;

  // On disk when it returns, but not synced. Throws std::invalid_argument for a path that leads outside, and
  // TargetError.
  void Add(const ClipFile& file);

  int64_t clip() const { return clip_; }
  const std::vector<StoredFile>& files() const {
    return files_;
  }  // path: ClipFile's; bundled, with its offset
  std::filesystem::path PlaceOf(const std::string& path) const;
  void Remove();

 private:
  int64_t clip_;
  bool bundled_;
  std::filesystem::path folder_;
  std::vector<StoredFile> files_;
};

}  // namespace shimmer::dataset
