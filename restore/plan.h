// What a video needs, decided once. Absent means skipped: this is the only place that asks what a video is
// like, and the pipeline does what the plan says. A plan is a value: `unshimmer plan` prints it.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "restore/background.h"
#include "restore/look.h"
#include "restore/sharpening_network.h"

namespace shimmer::restore {

enum class Border { kFill, kCrop };

struct RestoreParams {
  Border border = Border::kFill;
  bool stabilise = true;  // false: as if the camera had stood
  StabiliseParams shake = {};
  bool segment = true;  // false: as if nothing moved
  SegmentMethod method = SegmentMethod::kFused;
  bool stack = true;  // false: the turbulence stays as it is
  Register registered = Register::kAuto;
  std::optional<TileSize> sharpen = {};  // by a network with such tiles; none: not
};

struct RestorePlan {
  cv::Size size;  // of the video, px
  int64_t frames = 0;
  bool grey = false;   // one channel is restored
  bool alike = false;  // nothing changes: every result is the first frame
  bool stabilise = false;
  bool fill = false;     // what a moved frame does not see is taken from its neighbours
  cv::Rect picture;      // what of the frames is restored: all, or what is inside of bars that never change
  cv::Rect area;         // of the steady frame that is put out: without its bars where it is cropped
  bool segment = false;  // what moves is found, left out of the background and laid back into it
  bool stack = false;    // each frame's background is the mean of those around it
  int ahead = 0;         // of them on either side
  bool registered = false;                // to one another before that
  bool lucky = false;                     // and px count by how sharp a frame is there
  std::optional<TileSize> sharpen = {};   // by a network, in tiles
  std::vector<std::string> skipped = {};  // a line for each stage that is left out, and why

  friend bool operator==(const RestorePlan&, const RestorePlan&) = default;
};

// Of the frames that sharpening gets: cut, and without the bars that never change.
cv::Size SharpenedSize(const RestorePlan& plan);

// Whether there is a still scene to look at (LookAtScene): not where nothing changes, and not where a camera
// that is to be followed shows no one scene.
bool HasOneScene(const VideoFacts& facts, const RestoreParams& params);

// Throws std::invalid_argument where Border::kCrop leaves nothing that all frames see, as RequireTile does,
// and for a video that goes over to another scene (LastingCut), unless its camera is taken to have stood.
RestorePlan PlanRestore(const VideoFacts& facts, const RestoreParams& params);

}  // namespace shimmer::restore
