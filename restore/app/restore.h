// unshimmer restore and unshimmer plan.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>

#include "restore/app/optics_options.h"
#include "restore/app/restoration.h"

namespace shimmer::restore::app {

struct RestoreOptions {
  std::filesystem::path video, out, stages;  // stages may be empty: not wanted
  RestoreSettings settings;
  OpticsOptions optics;
  std::optional<double> frames_per_s;  // of a video that is written
  int threads = 0;                     // 0: all
  bool quiet = false;
};

// Both return the exit code, and throw as OpticsOf, OpenTools, OpenFrames, LookAtVideo, PlanFor and OpenSink
// do.
int RestoreVideo(const RestoreOptions& options, const std::atomic<bool>& stop);
int PrintPlan(const RestoreOptions& options, const std::atomic<bool>& stop);

}  // namespace shimmer::restore::app
