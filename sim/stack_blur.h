// The paper's blur: 11 copies of the frame, blurred by evenly spaced sigmas, and for each pixel the nearest
// copy or the two around it. Quick and rough: what it loses against exact_blur.h is measured in
// docs/model.md.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "sim/scene.h"

namespace shimmer::sim {

inline constexpr int kStackLevels = 11;

class BlurStack {
 public:
  // frame: CV_32FC1 or CV_32FC3 with GaussianRadius(max_sigma_px) px of border around the area to be read.
  BlurStack(const cv::Mat& frame, double min_sigma_px, double max_sigma_px);

  // out pixel i = the stack at first + (i, 0), first counted from the frame's corner without its border.
  void Row(cv::Point first, std::span<const float> sigma_px, LevelChoice choice, float* out) const;

  double sigma_px(int level) const;

 private:
  double min_sigma_px_, max_sigma_px_, step_px_;
  std::vector<cv::Mat> levels_;  // without the border
};

// One blurred copy: the sampled Gaussian of constant sigma, rows then columns. The border is used up: the
// result is smaller than frame by border_px on each side, border_px >= GaussianRadius(sigma_px).
cv::Mat GaussianBlur(const cv::Mat& frame, double sigma_px, int border_px);

}  // namespace shimmer::sim
