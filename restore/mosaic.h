// The mean of all frames so far, each moved back by its shift: what the next one is compared with. It lies on
// a canvas that is wider than a frame by the most that frames are shifted, so that all of a shifted frame
// finds what earlier frames saw there. A frame weighs 1/n of n: errors of single shifts die out with n and
// never add up, as they would from frame to frame, and so does the turbulence of the first frame.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::restore {

struct MosaicPart {
  cv::Mat mean;    // CV_32FC1; 0 where no frame was
  cv::Mat frames;  // CV_32FC1: how many frames saw each px
};

class Mosaic {
 public:
  // margin_px: of the canvas beyond a frame on each side, px of the level.
  Mosaic(cv::Size frame, int margin_px);
  Mosaic(Mosaic&&) = default;  // (a copy would share its pictures)
  Mosaic& operator=(Mosaic&&) = default;

  // Lays the frame's detail over the canvas, pixel (0, 0) at `at`, within the canvas. A rim of kRim_px, whose
  // local mean the frame's edge has spoiled, is left out.
  void Add(const cv::Mat& detail, cv::Point at);

  const MosaicPart& whole() const { return whole_; }
  MosaicPart Part(cv::Rect area) const;  // not to be written to; area lies within the canvas
  // The same as if that frame had never been added there.
  MosaicPart PartWithout(cv::Rect area, const cv::Mat& detail, cv::Point at) const;
  int margin_px() const { return margin_px_; }

  static constexpr int kRim_px = 3;

 private:
  int margin_px_;
  cv::Mat sum_;
  MosaicPart whole_;
};

}  // namespace shimmer::restore
