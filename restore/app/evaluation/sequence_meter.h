// A sequence measured frame by frame against the truth.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "restore/app/evaluation/measures.h"
#include "restore/app/evaluation/true_frame.h"

namespace shimmer::restore::app {

class SequenceMeter {
 public:
  // frame: of the truth's size, as levels.h takes it; the next one. found: CV_8UC1, what was found to move,
  // for stability where the truth does not say it; may be empty.
  void Add(const cv::Mat& frame, const TrueFrame& truth, const cv::Mat& found = {});

  // The means over the frames: of pictures, line deviation and stability.
  void AddTo(Measures& measures) const;

 private:
  // Against the clean frame: on all, background, foreground and box, PSNR then SSIM, as Measure has them.
  std::array<std::vector<Value>, 8> scores_;
  std::vector<Value> line_deviation_deg_, difference_levels_;
  cv::Mat before_, unsteady_before_;
};

// The masks that were found, against the true ones.
class MaskMeter {
 public:
  void Add(const cv::Mat& found, const TrueFrame& truth);  // found: CV_8UC1; empty: nothing moves
  void AddTo(Measures& measures) const;                    // the means over the frames

 private:
  std::vector<Value> iou_, precision_, recall_;
};

// The errors of shifts, in px.
void AddShiftErrors(std::vector<double> errors_px, Measures& measures);

}  // namespace shimmer::restore::app
