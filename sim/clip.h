// The degraded twin of a clean clip:
//   out_t = G[sigma_t] * w_t,   w_t(p) = clean_t(p + d_t(p)):  tilt, then blur.
// The clip is a window on an endless plane: around it lies what the source shows there, and beyond the
// source's edge its reflection. So nothing ends at the clip's border, and a crop of a clip is the clip of the
// crop.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "sim/plan.h"
#include "sim/sigma_map.h"
#include "sim/tilt_field.h"

namespace shimmer::sim {

// What was done to a frame.
struct FrameTruth {
  cv::Mat tilt;   // CV_32FC2, (dx, dy) in px; zeros where the plan has no tilt
  cv::Mat sigma;  // CV_32FC1 in px; zeros where the plan has no blur
};

struct RenderedFrame {
  cv::Mat turb;  // as the clean frame: CV_32FC1 or CV_32FC3
  FrameTruth truth;
};

class ClipRenderer {
 public:
  // plan = PlanClip(scene, ...). Computes what is frozen.
  ClipRenderer(const Scene& scene, const ClipPlan& plan, ClipKey key);

  // Frame t, whose clean twin has plan.halo_px more on each side than the clip (sim/crop.h). Any order, any
  // thread: the same bits. Throws std::invalid_argument if clean has another size or type.
  RenderedFrame Render(int64_t t, const cv::Mat& clean_with_halo) const;

  // The truth of frame t alone, without a picture.
  FrameTruth Truth(int64_t t) const;

  const std::optional<TiltField>& tilt_field() const { return tilt_; }
  const std::optional<BlurNoise>& blur_noise() const { return blur_noise_; }

 private:
  // Shifts over the clip and the border that the blur gathers from; empty without a tilt.
  struct Shifts {
    cv::Mat dx, dy;  // CV_32FC1
  };
  Shifts ComputeShifts(int64_t t) const;
  cv::Mat ComputeSigma(int64_t t, const Shifts& shifts) const;  // over the clip; empty without a blur
  FrameTruth TruthOf(const Shifts& shifts, const cv::Mat& sigma) const;

  Scene scene_;
  ClipPlan plan_;
  int border_px_ = 0;  // of the shifts, beyond the clip
  std::optional<TiltField> tilt_;
  std::optional<BlurNoise> blur_noise_;
  std::optional<Shifts> frozen_shifts_;
  std::optional<cv::Mat> frozen_sigma_;
};

}  // namespace shimmer::sim
