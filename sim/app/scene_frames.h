// The frames of a clip before turbulence: a background and what moves over it, seen by a camera that may
// shake.
#pragma once

#include <atomic>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "sim/app/clean_frames.h"
#include "sim/app/clip_objects.h"
#include "sim/clip.h"
#include "sim/moving_scene.h"

namespace shimmer::app {

class SceneFrames {
 public:
  // plan: PlanOf(config, ...). What is given must outlive this. Throws as CleanFrames, ObjectsOf and
  // sim::ShakePath; with `line` (the manifest's) saying what is known so far.
  SceneFrames(const Job& job, const Config& config, sim::ClipKey key, const std::atomic<bool>& stop,
              Json& line);

  bool still() const { return background_.still(); }
  void Use(const sim::ClipPlan& plan);

  // One frame; valid until the next is asked for. t: first_frame and on.
  struct Frame {
    const sim::CleanFrame* clean;  // for ClipRenderer::Render
    cv::Mat steady;                // the crop as a camera that stands sees it, the output's samples
    cv::Point2d shake_px;
    std::optional<sim::MovingScene::Frame> objects;
  };
  Frame At(int64_t t);

  // How the renderer sees it. border_px: ClipFields'.
  sim::FrameView ViewOf(const Frame& frame, int border_px) const;

  // Coverage of the steady frame by objects, and by the masks of the source: CV_32FC1 in [0, 1].
  cv::Mat Mask(int64_t t, const Frame& frame);

  // Way of what is seen in the steady frame to frame t + 1: CV_32FC2, px.
  cv::Mat Flow(const Frame& frame) const;

  cv::Point2d ShakeAt(int64_t t) const { return shake_.at(static_cast<size_t>(t - config_.first_frame)); }

  // What the manifest says of the source, complete after the first frame.
  const Json& record() const { return background_.record(); }

 private:
  const Config& config_;
  CleanFrames background_;
  ClipObjects objects_;
  std::vector<cv::Point2d> shake_;
  sim::ClipPlan plan_;
  std::optional<sim::MovingScene> scene_;        // none: nothing moves over the background
  std::optional<sim::CleanFrame> prepared_;      // of a still, or of the last frame
  std::optional<sim::ComposedFrames> composed_;  // of a still that something moves over
};

}  // namespace shimmer::app
