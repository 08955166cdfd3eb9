// One clip, from its index to the bytes of its files: the whole of what `shimmer generate` does, in memory.
#pragma once

#include <atomic>
#include <functional>

#include "sim/app/job.h"
#include "sim/dataset/interrupted.h"
#include "sim/dataset/staged_clip.h"

namespace shimmer::app {

using dataset::Interrupted;

// A function of (job, clip) alone: hands on each file as it is made, and fills in what the manifest says of
// the clip (drawn values, origins, plan, source, tilt RMS, mean sigma). Throws std::runtime_error where the
// source can't be used, with `line` holding what is known so far; Interrupted, between two frames, once stop
// is set; and what keep throws.
void MakeClip(const Job& job, int64_t clip, const std::atomic<bool>& stop,
              const std::function<void(const dataset::ClipFile&)>& keep, Json& line);

}  // namespace shimmer::app
