// unshimmer restore and unshimmer plan.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>

#include "restore/app/optics_options.h"
#include "restore/plan.h"

namespace shimmer::restore::app {

struct RestoreOptions {
  std::filesystem::path video, out, stages;  // stages may be empty: not wanted
  RestoreParams params;
  std::string flow = "dis";  // or the file of a network
  bool sharpen = true;
  std::filesystem::path model = {};  // the network that sharpens; empty: the one that the program carries
  OpticsOptions optics;
  std::optional<double> frames_per_s;  // of a video that is written
  int threads = 0;                     // 0: all
  bool quiet = false;
};

// Both return the exit code, and throw as OpticsOf, OpenNetwork, OpenFrames, TorchFlows, LookAt, PlanRestore
// and OpenSink do.
int RestoreVideo(const RestoreOptions& options, const std::atomic<bool>& stop);
int PrintPlan(const RestoreOptions& options, const std::atomic<bool>& stop);

}  // namespace shimmer::restore::app
