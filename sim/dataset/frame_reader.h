// Clean frames from files: stills, numbered pictures, videos.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "sim/dataset/image_io.h"
#include "sim/dataset/interrupted.h"
#include "sim/dataset/picture_cache.h"

namespace shimmer::dataset {

// Frames 0 .. count() - 1, in any order (a video goes fastest forward). For one thread at a time.
class FrameReader {
 public:
  virtual ~FrameReader() = default;
  virtual int64_t count() = 0;

  // As ReadSamples gives it; the pixels may be shared, and are not to be written to. Throws
  // std::invalid_argument if frame is outside [0, count()), std::runtime_error for a file that can't be read,
  // or whose size or number of channels differs from a frame read before.
  virtual Picture Read(int64_t frame) = 0;

  // Of a video, as its header says; absent of pictures.
  virtual std::optional<double> frames_per_s() const { return {}; }

  // What is odd about the source though it can be used; empty if nothing. Known once count() was asked for.
  virtual std::string remark() const { return {}; }

 protected:
  static void RequireFrame(int64_t frame, int64_t count);  // throws "frame = 12, must be in [0, 9]"
};

// One frame, and those of SequenceFiles (sources.h). Read through the cache if there is one; it must outlive
// the reader.
std::unique_ptr<FrameReader> OpenStill(const std::filesystem::path& path, PictureCache* cache = nullptr);
std::unique_ptr<FrameReader> OpenSequence(const std::filesystem::path& sequence,
                                          PictureCache* cache = nullptr);

// Frames are decoded forward from the start, never sought: the same frame whatever was read before. 8-bit
// RGB. count() decodes the video once, since headers lie; known_count, from an earlier reader of the file,
// saves that. Reading throws Interrupted once stop is set, which must outlive the reader.
std::unique_ptr<FrameReader> OpenVideo(const std::filesystem::path& path,
                                       std::optional<int64_t> known_count = {},
                                       const std::atomic<bool>& stop = kNeverStop);

}  // namespace shimmer::dataset
