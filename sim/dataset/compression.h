// What a camera's lossy compression leaves of its frames: they are encoded in memory and decoded again.
//
// The result is a function of the frames and the settings alone: one thread, no time, the same whatever other
// threads do. It is not promised across versions of libjpeg and x264. Nothing is printed.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

namespace shimmer::dataset {

// JPEG; the colour of RGB is one for 2x2 pixels (4:2:0). frame: CV_8UC1 or CV_8UC3 (RGB), each side up to
// kMaxSide_px; quality in [1, 100]. The result has its size and type. Throws std::invalid_argument for
// anything else.
cv::Mat ThroughJpeg(const cv::Mat& frame, int quality);

inline constexpr int kMaxH264Side_px = 16384;

// H.264 by x264: frames of one size and type in their order, each predicted from those before. 8 bits, 4:2:0,
// a key frame every 50 at the latest. Grey is luma of the full range [0, 255]; RGB goes through BT.709 of the
// limited range. Memory doesn't grow with the frames.
class H264Stream {
 public:
  // size: up to kMaxH264Side_px each way; channels: 1 or 3 (RGB); crf (x264's constant rate factor) in [0,
  // 51], less is better: x264's own default is 23, and below 1 luma and chroma come back as they were. Throws
  // std::invalid_argument for anything else, std::runtime_error if this FFmpeg has no libx264 or no H.264
  // decoder, or they can't be opened.
  H264Stream(cv::Size size, int channels, double crf);
  ~H264Stream();

  // The next frame, as it is decoded from the stream so far. frame: CV_8UC1 or CV_8UC3, of the stream's size;
  // so is the result. Throws std::invalid_argument for another frame, which the stream then doesn't contain;
  // std::runtime_error if FFmpeg fails, after which the stream is of no use.
  cv::Mat Through(const cv::Mat& frame);

 private:
  struct Codecs;
  std::unique_ptr<Codecs> codecs_;
};

}  // namespace shimmer::dataset
