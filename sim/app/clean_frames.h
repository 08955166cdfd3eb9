// The clean frames of one clip, as the simulation and the clean file see them: scaled, cropped with a halo,
// mirrored, in the output's light, and rounded to the output's bits, so that the pair agrees to the last bit
// that is on disk.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "sim/app/config/config.h"
#include "sim/app/source_list.h"
#include "sim/dataset/image_io.h"
#include "sim/draw.h"

namespace shimmer::app {

cv::Size Scaled(cv::Size size, double scale);  // to the nearest pixel, at least one each way

dataset::Encoding EncodingOf(const OutputParams& output);

// True where frames on disk are linear light: EXR, in colour "linear".
bool OutputIsLinear(const Config& config);

class CleanFrames {
 public:
  // Chooses the source and the place in it by the clip's hash. Throws std::runtime_error if the source can't
  // be read or is too small or too short, dataset::Interrupted once stop is set and a video is read.
  CleanFrames(const SourceList& sources, dataset::PictureCache& pictures, const Config& config,
              sim::ClipKey key, const std::atomic<bool>& stop = dataset::kNeverStop);

  bool still() const;

  // Frame t (config.first_frame .. ) with around_px more on each side than the clip, as the output's samples:
  // CV_8U or CV_16U for PNG, CV_32F for EXR. A still is read once. Only what the frame shows is resized.
  // The source holds the crop and, on each side, what the camera's shake may reach; what lies further out is
  // its reflection. Throws std::runtime_error where it does not.
  cv::Mat Frame(int64_t t, int around_px);

  // How much of each pixel of frame t its masks cover, CV_32FC1 in [0, 1]; empty where the source has none.
  // Throws std::runtime_error for a mask of another size than its frame.
  cv::Mat Mask(int64_t t);

  // {"path", "sha256", "scale", "crop": [x, y, w, h], "flip", "start", ...}: what was chosen, for
  // the manifest. Complete after the first Frame().
  const Json& record() const { return record_; }

 private:
  // Where in a picture of this size the clip lies.
  struct Place {
    double scale;
    cv::Size scaled;
    cv::Rect crop;
  };
  Place PlaceIn(cv::Size size) const;
  double FittingScale(cv::Size size) const;
  cv::Rect ChooseCrop(cv::Size scaled) const;
  cv::Mat Prepare(const dataset::Picture& picture, int around_px);

  const SourceList& sources_;
  const Config& config_;
  sim::ClipKey key_;
  size_t item_ = 0;
  std::unique_ptr<dataset::FrameReader> reader_;  // null for drawn scenes
  std::unique_ptr<dataset::FrameReader> masks_;   // null where there are none
  cv::Size reach_px_;                             // of the shake, on each side of the crop
  int64_t start_ = 0;
  uint64_t variation_ = 0;  // of a drawn scene
  bool flip_ = false;
  Json record_;
  cv::Mat still_frame_;
  int still_around_px_ = -1;
};

}  // namespace shimmer::app
