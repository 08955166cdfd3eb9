// What turbulence does to a clip: the shift and the sigma of every pixel in every frame.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <span>

#include "sim/plan.h"
#include "sim/sigma_map.h"
#include "sim/tilt_field.h"

namespace shimmer::sim {

// What was done to a frame.
struct FrameTruth {
  cv::Mat tilt;   // CV_32FC2, (dx, dy) in px; zeros where the plan has no tilt
  cv::Mat sigma;  // CV_32FC1 in px; zeros where the plan has no blur
};

class ClipFields {
 public:
  // plan = PlanClip(scene, ...). Computes what is frozen.
  ClipFields(const Scene& scene, const ClipPlan& plan, ClipKey key);

  // Px around the clip in which shifts are known too: the blur gathers from there.
  int border_px() const { return border_px_; }

  ClipKey key() const { return key_; }

  // The fields of one frame, to be read row by row from any thread.
  class Frame {
   public:
    // Shifts of row y, -border_px <= y < height + border_px, from pixel -border_px on: width + 2 border_px of
    // them. Zeros where the plan has no tilt.
    void Shifts(int y, std::span<float> dx, std::span<float> dy) const;

    // Sigmas of row y of the clip; dx, dy: the shifts of its pixels. Zeros where the plan has no blur.
    void Sigmas(int y, std::span<const float> dx, std::span<const float> dy, std::span<float> sigma) const;

   private:
    friend class ClipFields;
    explicit Frame(const ClipFields& clip) : clip_(&clip) {}
    const ClipFields* clip_;
    std::optional<noise::PlannedOctaves::Frame> x_, y_, noise_;  // none where a map is frozen, or all zero
  };
  Frame At(int64_t t) const;

  // All of frame t.
  FrameTruth Truth(int64_t t) const;

  const std::optional<TiltField>& tilt() const { return tilt_; }
  const std::optional<BlurNoise>& blur_noise() const {
    return blur_noise_;
  }  // none: the map has no such part

 private:
  struct Maps {  // CV_32FC1, with the border and without
    cv::Mat dx, dy, sigma;
  };
  Maps Compute(int64_t t) const;

  Scene scene_;
  ClipPlan plan_;
  ClipKey key_;
  int border_px_;
  std::optional<TiltField> tilt_;
  std::optional<BlurNoise> blur_noise_;
  std::optional<PlannedTilt> planned_tilt_;
  std::optional<noise::PlannedOctaves> planned_noise_;
  Maps frozen_;  // empty where nothing is
};

}  // namespace shimmer::sim
