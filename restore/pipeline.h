// Frames through the stages that a plan names, several at once: while one is read another is stabilised, and
// so on. What comes out is the same on any number of threads.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "restore/frames.h"
#include "restore/plan.h"
#include "restore/stages.h"

namespace shimmer::restore {

// video: what was looked at; of frames with bars their Inside, around which the bars are put back. sharpener:
// of frames of SharpenedSize, where the plan sharpens; else none. sink gets every frame, in order, and for
// one thread at a time. Memory: what the stages hold, and a few frames between them, however long the video
// is. Throws what reading, a stage or the sink throws.
//
// times: gets the seconds that each stage took, by its name. Frames then go one after the other, so that a
// stage has all threads and its time is its own; reading and the sink are in none.
using StageTimes = std::map<std::string, double>;
void Restore(Frames& video, const VideoFacts& facts, const RestorePlan& plan, Sharpener* sharpener,
             const std::function<void(const FrameOnWay&)>& sink, StageTimes* times = nullptr);

}  // namespace shimmer::restore
