// The moving objects of a clip, from its config: what each looks like, and how it moves.
#pragma once

#include <atomic>
#include <vector>

#include "sim/app/job.h"
#include "sim/moving_scene.h"

namespace shimmer::app {

struct ClipObjects {
  std::vector<sim::PlacedObject> placed;  // those that are present, from the farthest to the nearest
  Json record = Json::array();            // of each of them: "object", and of files what was chosen
};

// A function of (job, config, key) alone. Reading a video throws dataset::Interrupted once stop is set; both
// must outlive the result. Throws std::runtime_error "objects.2...: what is wrong": a file that can't be
// read, a cut-out without alpha, masks of another size, a path that leaves the scene.
ClipObjects ObjectsOf(const Job& job, const Config& config, sim::ClipKey key, const std::atomic<bool>& stop);

}  // namespace shimmer::app
