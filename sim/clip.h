// The degraded twin of a clean clip:
//   out_t = G[sigma_t] * w_t,   w_t(p) = clean_t(p + d_t(p)):  tilt, then blur.
// The clip is a window on an endless plane: around it lies what the source shows there, and beyond the
// source's edge its reflection.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "sim/frame_render.h"

namespace shimmer::sim {

class ClipRenderer {
 public:
  // plan = PlanClip(scene, ...). Computes what is frozen.
  ClipRenderer(const Scene& scene, const ClipPlan& plan, ClipKey key);
  ~ClipRenderer();

  // The clean twin of a frame, or of all frames of a still. samples: plan.AroundPx() more on each side than
  // the clip (sim/crop.h). Throws std::invalid_argument for another size, and as CleanFrame does.
  CleanFrame Prepare(const cv::Mat& samples) const;

  // Frame t, as it is seen. clean: Prepare's, or one that holds plan.Window(view.shake_px). Any order, any
  // thread: the same bits. What `frame` held is overwritten where it has the right size, so that a caller who
  // keeps it asks for no memory again. Throws std::invalid_argument for a clean frame that is too small.
  void Render(int64_t t, const CleanFrame& clean, bool with_truth, RenderedFrame& frame,
              const FrameView& view = {}) const;

  // One frame, all of it, by a camera that stands.
  RenderedFrame Render(int64_t t, const cv::Mat& samples) const;

  const ClipFields& fields() const { return fields_; }

 private:
  class MemoryPool;  // kept from frame to frame

  Scene scene_;
  ClipPlan plan_;
  ClipFields fields_;
  std::unique_ptr<MemoryPool> pool_;
};

}  // namespace shimmer::sim
