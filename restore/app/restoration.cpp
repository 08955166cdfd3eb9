#include "restore/app/restoration.h"

#include <optional>

#include "restore/open_network.h"
#include "restore/torch_flow.h"
#include "sim/dataset/interrupted.h"

namespace shimmer::restore::app {
namespace {

FlowMaker FlowOf(const std::string& name) {
  if (name == "dis") return DisFlows();
  if (name == "farneback") return FarnebackFlows();
  return TorchFlows(name);
}

// video: the inside of what changes.
VideoFacts Look(Frames& video, const RestoreSettings& settings, const RestoreTools& tools,
                bool wants_strength, const Changing& changing, const Watcher& watcher) {
  const RestoreParams& params = settings.params;
  watcher.begin("frames looked at", video.count());
  VideoFacts facts = LookAt(video, params.shake, watcher.step, changing);
  if (!HasOneScene(facts, params) || !(params.stack || wants_strength)) return facts;
  watcher.begin("places looked at", ReadsOfLook(facts.frames));
  const bool moved = params.stabilise && !IsSteady(facts.shifts);
  facts.scene =
      LookAtScene(video, moved ? facts.shifts : std::vector<FrameShift>(), facts.grey, params.method,
                  tools.flow, params.stack ? params.registered : Register::kOff, watcher.step);
  return facts;
}

}  // namespace

RestoreTools OpenTools(const RestoreSettings& settings) {
  RestoreTools tools{.flow = FlowOf(settings.flow), .network = nullptr};
  if (settings.sharpen)
    tools.network = settings.model.empty() ? ShippedNetwork() : OpenNetwork(settings.model);
  return tools;
}

cv::Mat FileFrames::Read(int64_t frame) {
  if (stop_) throw dataset::Interrupted();
  return reader_.Read(frame).pixels;
}

Watcher NoWatcher() {
  return {.begin = [](const std::string&, int64_t) {}, .step = [] {}};
}

LookedAt LookAtVideo(Frames& video, const RestoreSettings& settings, const RestoreTools& tools,
                     bool wants_strength, const Watcher& watcher) {
  LookedAt looked;
  watcher.begin("frames compared", video.count());
  looked.changing = FindChanging(video, watcher.step);
  Inside inside(video, looked.changing.area);
  looked.facts = Look(inside, settings, tools, wants_strength, looked.changing, watcher);
  return looked;
}

RestorePlan PlanFor(const LookedAt& looked, const RestoreSettings& settings, const RestoreTools& tools) {
  RestoreParams params = settings.params;
  if (tools.network) params.sharpen = tools.network->tile();
  return PlanRestore(looked.facts, params);
}

SharpenCounts RestoreAsPlanned(Frames& video, const LookedAt& looked, const RestorePlan& plan,
                               const RestoreTools& tools, const std::function<void(const FrameOnWay&)>& sink,
                               StageTimes* times) {
  Inside inside(video, looked.changing.area);
  std::optional<Sharpener> sharpener;
  if (plan.sharpen) sharpener.emplace(tools.network, SharpenedSize(plan));
  Restore(inside, looked.facts, plan, sharpener ? &*sharpener : nullptr, sink, times);
  return sharpener ? sharpener->counts() : SharpenCounts();
}

}  // namespace shimmer::restore::app
