// Where restored frames go: a folder of pictures, or a video.
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

namespace shimmer::restore::app {

// Frames are written beside, and stand at their place once all of them are there: what a run leaves that was
// ended is "PATH.part" (of x.mp4 "x.part.mp4"), which the next one replaces.
class FrameSink {
 public:
  virtual ~FrameSink() = default;  // before Finish(): takes what was written away
  // CV_8U, CV_16U or CV_32F of 1 or 3 (RGB) channels, of one size and type.
  virtual void Add(const cv::Mat& frame) = 0;
  virtual void Finish() = 0;  // throws std::runtime_error, as Add does, for what can't be written
};

// path: a name that ends in .mp4, .mkv, .mov or .avi is a video of 8 bits, any other a folder of numbered
// pictures, 0000.png and on: PNG of the frames' own bits, EXR of 16 for floats. Throws std::invalid_argument
// for a path that is there, but for an empty folder.
std::unique_ptr<FrameSink> OpenSink(const std::filesystem::path& path, double frames_per_s);

}  // namespace shimmer::restore::app
