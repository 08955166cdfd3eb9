#include "restore/app/restore.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <thread>

#include "cli/command_line.h"
#include "cli/error_line.h"
#include "cli/exit_codes.h"
#include "cli/progress.h"
#include "restore/app/frame_sink.h"
#include "restore/app/frame_source.h"
#include "restore/app/plan_text.h"
#include "restore/app/stage_files.h"
#include "restore/open_network.h"
#include "restore/pipeline.h"
#include "restore/torch_flow.h"

namespace shimmer::restore::app {
namespace {

constexpr double kFramesPerS = 25;  // of pictures, which don't say

// A file's frames, until the person asks to stop.
class FileFrames : public Frames {
 public:
  FileFrames(dataset::FrameReader& reader, const std::atomic<bool>& stop) : reader_(reader), stop_(stop) {}

  int64_t count() override { return reader_.count(); }
  cv::Mat Read(int64_t frame) override {
    if (stop_) throw dataset::Interrupted();
    return reader_.Read(frame).pixels;
  }

 private:
  dataset::FrameReader& reader_;
  const std::atomic<bool>& stop_;
};

// The network that sharpens; none where it is switched off.
std::shared_ptr<SharpeningNetwork> NetworkOf(const RestoreOptions& options) {
  if (!options.sharpen) return nullptr;
  return options.model.empty() ? ShippedNetwork() : OpenNetwork(options.model);
}

RestorePlan PlanOf(const RestoreOptions& options, const VideoFacts& facts, const SharpeningNetwork* network) {
  RestoreParams params = options.params;
  if (network) params.sharpen = network->tile();
  return PlanRestore(facts, params);
}

FlowMaker FlowOf(const RestoreOptions& options) {
  if (options.flow == "dis") return DisFlows();
  return TorchFlows(options.flow);
}

// No more threads than were asked for, while it lives.
class Threads {
 public:
  explicit Threads(int threads)
      : control_(
            tbb::global_control::max_allowed_parallelism,
            static_cast<size_t>(
                threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency())))) {
  }

 private:
  tbb::global_control control_;
};

Changing Compare(const RestoreOptions& options, Frames& video) {
  cli::Progress progress("frames compared", video.count(), 0, options.quiet);
  return FindChanging(video, [&] { progress.Step(); });
}

// video: the inside of what changes.
VideoFacts Look(const RestoreOptions& options, const std::optional<Optics>& optics, const Changing& changing,
                const FlowMaker& flow, Frames& video) {
  const RestoreParams& params = options.params;
  VideoFacts facts;
  {
    cli::Progress progress("frames looked at", video.count(), 0, options.quiet);
    facts = LookAt(
        video, params.shake, [&] { progress.Step(); }, changing);
  }
  if (!HasOneScene(facts, params) || !(params.stack || optics)) return facts;
  cli::Progress progress("places looked at", ReadsOfLook(facts.frames), 0, options.quiet);
  const bool moved = params.stabilise && !IsSteady(facts.shifts);
  facts.scene =
      LookAtScene(video, moved ? facts.shifts : std::vector<FrameShift>(), facts.grey, params.method, flow,
                  params.stack ? params.registered : Register::kOff, [&] { progress.Step(); });
  return facts;
}

void Run(const RestoreOptions& options, const std::optional<Optics>& optics, dataset::FrameReader& reader,
         const std::shared_ptr<SharpeningNetwork>& network, const std::atomic<bool>& stop) {
  FileFrames file(reader, stop);
  const double frames_per_s = options.frames_per_s.value_or(reader.frames_per_s().value_or(kFramesPerS));
  const std::unique_ptr<FrameSink> out = OpenSink(options.out, frames_per_s);
  const std::unique_ptr<StageFiles> stages =
      options.stages.empty() ? nullptr : std::make_unique<StageFiles>(options.stages);
  const Changing changing = Compare(options, file);
  Inside video(file, changing.area);
  const VideoFacts facts = Look(options, optics, changing, FlowOf(options), video);
  const RestorePlan plan = PlanOf(options, facts, network.get());
  std::optional<Sharpener> sharpener;
  if (plan.sharpen) sharpener.emplace(network, SharpenedSize(plan));
  cli::Progress progress("frames restored", facts.frames, 0, options.quiet);
  Restore(video, facts, plan, sharpener ? &*sharpener : nullptr, [&](const FrameOnWay& frame) {
    out->Add(frame.frame);
    if (stages) stages->Add(frame);
    progress.Step();
  });
  progress.End();
  if (stages) stages->Finish(facts, plan, optics, sharpener ? sharpener->counts() : SharpenCounts());
  out->Finish();
}

// Says what is odd about a video that can be used all the same: one that was cut off, for instance.
std::unique_ptr<dataset::FrameReader> Opened(const RestoreOptions& options, const std::atomic<bool>& stop) {
  auto reader = OpenFrames(options.video, stop);
  reader->count();
  if (const std::string remark = reader->remark(); !remark.empty())
    cli::PrintError("unshimmer", options.video.string() + ": " + remark);
  return reader;
}

}  // namespace

int RestoreVideo(const RestoreOptions& options, const std::atomic<bool>& stop) {
  const std::optional<Optics> optics = OpticsOf(options.optics);
  const Threads threads(options.threads);
  const std::shared_ptr<SharpeningNetwork> network = NetworkOf(options);
  try {
    const auto reader = Opened(options, stop);
    Run(options, optics, *reader, network, stop);
  } catch (const dataset::Interrupted&) {
    return cli::kExitInterrupted;
  }
  return cli::kExitDone;
}

int PrintPlan(const RestoreOptions& options, const std::atomic<bool>& stop) {
  const std::optional<Optics> optics = OpticsOf(options.optics);
  const Threads threads(options.threads);
  const std::shared_ptr<SharpeningNetwork> network = NetworkOf(options);
  try {
    const auto reader = Opened(options, stop);
    FileFrames file(*reader, stop);
    const Changing changing = Compare(options, file);
    Inside video(file, changing.area);
    const VideoFacts facts = Look(options, optics, changing, FlowOf(options), video);
    cli::Print(PlanText(facts, PlanOf(options, facts, network.get()), optics));
  } catch (const dataset::Interrupted&) {
    return cli::kExitInterrupted;
  }
  return cli::kExitDone;
}

}  // namespace shimmer::restore::app
