// A video restored: what `unshimmer restore` does between reading frames and writing them.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "restore/pipeline.h"
#include "restore/plan.h"
#include "sim/dataset/frame_reader.h"

namespace shimmer::restore::app {

struct RestoreSettings {
  RestoreParams params;
  std::string flow = "dis";  // or "farneback", or the file of a network
  bool sharpen = true;
  std::filesystem::path model = {};  // the network that sharpens; empty: the one that the program carries
};

// What is opened once, for any number of videos.
struct RestoreTools {
  FlowMaker flow;
  std::shared_ptr<SharpeningNetwork> network;  // none where sharpening is switched off
};
// Throws as OpenNetwork and TorchFlows do.
RestoreTools OpenTools(const RestoreSettings& settings);

// A file's frames, until the person asks to stop.
class FileFrames : public Frames {
 public:
  FileFrames(dataset::FrameReader& reader, const std::atomic<bool>& stop) : reader_(reader), stop_(stop) {}

  int64_t count() override { return reader_.count(); }
  cv::Mat Read(int64_t frame) override;  // throws dataset::Interrupted

 private:
  dataset::FrameReader& reader_;
  const std::atomic<bool>& stop_;
};

// Who wants to know how far it is: begin says what is counted, and how many there are; then each one is done.
struct Watcher {
  std::function<void(const std::string& what, int64_t count)> begin;
  std::function<void()> step;
};
Watcher NoWatcher();

struct LookedAt {
  Changing changing;
  VideoFacts facts;
};

// wants_strength: of the turbulence, though nothing is stacked. Throws as LookAt and LookAtScene do.
LookedAt LookAtVideo(Frames& video, const RestoreSettings& settings, const RestoreTools& tools,
                     bool wants_strength, const Watcher& watcher);

// Throws as PlanRestore does.
RestorePlan PlanFor(const LookedAt& looked, const RestoreSettings& settings, const RestoreTools& tools);

// sink and times: as Restore has them.
SharpenCounts RestoreAsPlanned(Frames& video, const LookedAt& looked, const RestorePlan& plan,
                               const RestoreTools& tools, const std::function<void(const FrameOnWay&)>& sink,
                               StageTimes* times = nullptr);

}  // namespace shimmer::restore::app
