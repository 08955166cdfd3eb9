// The stages of restoration, each a step that frames go through in order.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "restore/look.h"
#include "restore/plan.h"
#include "restore/sharpen.h"

namespace shimmer::restore {

// A frame on its way. What a stage that the plan leaves out would have made is empty.
struct FrameOnWay {
  int64_t index = 0;
  cv::Mat frame;      // as it was read; then as the camera of the first frame would see it; then restored
  cv::Mat steady;     // as it left stabilising; the frame itself where there is none
  cv::Mat own;        // CV_8UC1: 255 where the frame saw it itself, 0 where it is filled; empty: all its own
  cv::Mat mask = {};  // CV_8UC1: 255 where something moves, between where that is not sure
  cv::Mat background = {};  // the still scene, of the frames around this one
  cv::Mat blended = {};     // what was sharpened
};

class Stage {
 public:
  virtual ~Stage() = default;
  // The frames that are done now, in order. A stage may hold back some that need later ones.
  virtual std::vector<FrameOnWay> Next(FrameOnWay frame) = 0;
  virtual std::vector<FrameOnWay> Rest() = 0;  // after the last
};

struct NamedStage {
  const char* name;  // "stabilise", "segment", "stack", "blend", "sharpen"; of others what they do
  std::unique_ptr<Stage> stage;
};

// Those that the plan names, in order. sharpener: of frames of SharpenedSize, where the plan sharpens.
std::vector<NamedStage> StagesOf(const RestorePlan& plan, const VideoFacts& facts, Sharpener* sharpener);

}  // namespace shimmer::restore
