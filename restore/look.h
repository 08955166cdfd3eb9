// What a video is like: found by looking at all of it once, before anything is restored.
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "restore/changing.h"
#include "restore/frames.h"
#include "restore/scene_look.h"
#include "restore/stabilise.h"

namespace shimmer::restore {

struct VideoFacts {
  cv::Size size = {};  // of what is looked at: the frames, or the picture inside their bars
  int type = 0;
  int64_t frames = 0;
  bool grey = false;   // one channel, or three that are equal in every px of every frame
  bool alike = false;  // every frame is the first one, bit by bit
  std::vector<FrameShift> shifts = {};
  Changing changing = {};                // FindChanging's, where it was asked for
  std::optional<SceneFacts> scene = {};  // where frames are to be stacked: LookAtScene's
};

// changing: FindChanging's, of which the video is the Inside. step: called after each frame. Throws
// std::invalid_argument for frames that Stabiliser refuses, and what reading throws.
VideoFacts LookAt(Frames& video, const StabiliseParams& params, const std::function<void()>& step,
                  const Changing& changing = {});

}  // namespace shimmer::restore
