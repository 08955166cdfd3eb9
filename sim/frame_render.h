// One frame of a clip in the making (sim/clip.h): tilt, then blur, band by band of rows on all threads.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "sim/clean_frame.h"
#include "sim/clip_fields.h"
#include "sim/plan.h"
#include "sim/planes.h"

namespace shimmer::sim {

// How a frame is seen.
struct FrameView {
  cv::Point2d shake_px = {};  // sim/camera.h
  // Factor on tilt and sigma of each pixel, [0, 1]: CV_32FC1, the clip with ClipFields::border_px() around
  // it. Wanted where the plan has own_distances.
  cv::Mat strength = {};
};

struct RenderedFrame {
  cv::Mat turb;                // of the clean frame's type
  double tilt_square_px2 = 0;  // mean over the clip's pixels and both axes of the squared shift
  double mean_sigma_px = 0;
  std::optional<FrameTruth> truth;  // if it was asked for
};

// What a frame needs while it is made; to be used again for the next.
struct FrameMemory {
  Planes warped;  // the clip and the border that the blur gathers from
  cv::Mat sigma;
};

// Frame t of the clip that plan and fields are of. What `out` held is overwritten where it has the right
// size.
void RenderFrame(const Scene& scene, const ClipPlan& plan, const ClipFields& fields, int64_t t,
                 const CleanFrame& clean, const FrameView& view, bool with_truth, FrameMemory& memory,
                 RenderedFrame& out);

}  // namespace shimmer::sim
