#include "sim/dataset/video_write.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <string>

namespace shimmer::dataset {

struct VideoWriter::Writer {
  cv::VideoWriter file;
};

bool IsVideoName(const std::filesystem::path& path) {
  constexpr std::array<const char*, 4> kExtensions = {".mp4", ".mkv", ".mov", ".avi"};
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::ranges::count(kExtensions, extension) > 0;
}

VideoWriter::VideoWriter(const std::filesystem::path& path, cv::Size size, double frames_per_s)
    : writer_(std::make_unique<Writer>()), size_(size) {
  const cv::Size even(size.width + size.width % 2, size.height + size.height % 2);
  for (const char* code : {"avc1", "mp4v"})
    if (writer_->file.open(path.string(), cv::CAP_FFMPEG,
                           cv::VideoWriter::fourcc(code[0], code[1], code[2], code[3]), frames_per_s, even))
      return;
  throw std::runtime_error(path.string() + ": can't be written as a video");
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::Add(const cv::Mat& frame) {
  if (frame.size() != size_ || (frame.type() != CV_8UC1 && frame.type() != CV_8UC3))
    throw std::invalid_argument("VideoWriter: frame must be CV_8UC1 or CV_8UC3, of the video's size");
  cv::Mat bgr;
  cv::cvtColor(frame, bgr, frame.channels() == 1 ? cv::COLOR_GRAY2BGR : cv::COLOR_RGB2BGR);
  cv::copyMakeBorder(bgr, bgr, 0, size_.height % 2, 0, size_.width % 2, cv::BORDER_REPLICATE);
  writer_->file.write(bgr);
}

}  // namespace shimmer::dataset
