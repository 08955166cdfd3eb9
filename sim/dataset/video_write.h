// Videos for people to look at: lossy, 8 bits.
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

namespace shimmer::dataset {

// Whether a name is one of a video that VideoWriter writes: it ends in .mp4, .mkv, .mov or .avi.
bool IsVideoName(const std::filesystem::path& path);

class VideoWriter {
 public:
  // H.264 where this FFmpeg has an encoder, else MPEG-4. An odd side gets its last row or column twice, for
  // these have even ones alone. Throws std::runtime_error if it can't be opened.
  VideoWriter(const std::filesystem::path& path, cv::Size size, double frames_per_s);
  ~VideoWriter();  // after it the file is whole

  // CV_8UC1 or CV_8UC3 (RGB), of the size; else throws std::invalid_argument.
  void Add(const cv::Mat& frame);

 private:
  struct Writer;
  std::unique_ptr<Writer> writer_;
  cv::Size size_;
};

}  // namespace shimmer::dataset
