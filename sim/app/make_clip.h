// One clip, from its index to the bytes of its files: the whole of what `shimmer generate` does, in memory.
#pragma once

#include <atomic>
#include <stdexcept>
#include <vector>

#include "sim/app/job.h"
#include "sim/dataset/dataset_writer.h"

namespace shimmer::app {

struct MadeClip {
  std::vector<dataset::ClipFile> files;
  Json line;  // for the manifest: drawn values, origins, plan, source, tilt RMS, mean sigma
};

// The person has asked to stop.
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

// A function of (job, clip) alone. Throws std::runtime_error where the source can't be used, with `line`
// holding what is known so far; Interrupted, between two frames, once stop is set.
MadeClip MakeClip(const Job& job, int64_t clip, const std::atomic<bool>& stop, Json& line);

}  // namespace shimmer::app
