// What the scene of a video is like once its camera is taken to stand: what moves in it, and how strong the
// turbulence is.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "restore/background.h"
#include "restore/frames.h"
#include "restore/segment.h"
#include "restore/stabilise.h"
#include "restore/turbulence_strength.h"

namespace shimmer::restore {

struct SceneFacts {
  SegmentSettings segment;
  double moving_share =
      0;  // of the frames looked at, what moves in them; kAof: 1 or 0, whether anything does
  TurbulenceStrength strength = {};
  double luck_octaves = 0;        // how much the blur changes (LuckSpread)
  SceneReference reference = {};  // of kFused, where frames are to be registered
};

// At places evenly spread over the video, with their neighbours; then at the places once more, to see what
// moves there, and how strong the air is elsewhere. shifts: empty where frames are taken as they are; grey:
// one channel of them; registered: whether frames are to be, as BackgroundFor says. Frames are read forward,
// but for one start anew. step: called after each read. Throws what reading and the flow throw.
SceneFacts LookAtScene(Frames& video, std::span<const FrameShift> shifts, bool grey, SegmentMethod method,
                       const FlowMaker& flow, Register registered, const std::function<void()>& step);

// How many frames that reads.
int64_t ReadsOfLook(int64_t frames);

}  // namespace shimmer::restore
