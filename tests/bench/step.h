// One face to the renderer for all benchmarks, memory to memory: whatever the renderer's own interface is,
// they see this one.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "sim/clip.h"

namespace shimmer::bench {

class Step {
 public:
  Step(const sim::Scene& scene, const sim::ClipShape& shape, const sim::Accuracy& accuracy);

  int halo_px() const { return plan_.halo_px; }

  // The clean frame with halo_px() more on each side, 8 bit or float, 1 or 3 channels. Once for a still, each
  // frame for a video; clean must outlive its use.
  void Prepare(const cv::Mat& clean);

  // Frame t of the clip, in the depth and channels of the clean one. turb is reused.
  void Render(int64_t t, cv::Mat& turb);

  // The shifts and sigmas that Render uses for frame t.
  sim::FrameTruth Fields(int64_t t) const { return renderer_.fields().Truth(t); }

 private:
  sim::ClipPlan plan_;
  sim::ClipRenderer renderer_;
  std::optional<sim::CleanFrame> clean_;
  sim::RenderedFrame frame_;
};

inline constexpr sim::ClipKey kBenchClip{.seed = 7, .clip = 0};

}  // namespace shimmer::bench
