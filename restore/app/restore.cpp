#include "restore/app/restore.h"

#include <memory>
#include <optional>
#include <string>

#include "cli/command_line.h"
#include "cli/error_line.h"
#include "cli/exit_codes.h"
#include "cli/progress.h"
#include "restore/app/frame_sink.h"
#include "restore/app/frame_source.h"
#include "restore/app/plan_text.h"
#include "restore/app/stage_files.h"
#include "restore/app/threads.h"

namespace shimmer::restore::app {
namespace {

constexpr double kFramesPerS = 25;  // of pictures, which don't say

// With a bar for one kind of step after the other.
LookedAt Look(const RestoreOptions& options, const std::optional<Optics>& optics, const RestoreTools& tools,
              Frames& video) {
  std::optional<cli::Progress> progress;
  return LookAtVideo(video, options.settings, tools, optics.has_value(),
                     {.begin = [&](const std::string& what,
                                   int64_t count) { progress.emplace(what, count, 0, options.quiet); },
                      .step = [&] { progress->Step(); }});
}

void Run(const RestoreOptions& options, const std::optional<Optics>& optics, const RestoreTools& tools,
         dataset::FrameReader& reader, const std::atomic<bool>& stop) {
  FileFrames video(reader, stop);
  const double frames_per_s = options.frames_per_s.value_or(reader.frames_per_s().value_or(kFramesPerS));
  const std::unique_ptr<FrameSink> out = OpenSink(options.out, frames_per_s);
  const std::unique_ptr<StageFiles> stages =
      options.stages.empty() ? nullptr : std::make_unique<StageFiles>(options.stages);
  const LookedAt looked = Look(options, optics, tools, video);
  const RestorePlan plan = PlanFor(looked, options.settings, tools);
  cli::Progress progress("frames restored", looked.facts.frames, 0, options.quiet);
  const SharpenCounts counts = RestoreAsPlanned(video, looked, plan, tools, [&](const FrameOnWay& frame) {
    out->Add(frame.frame);
    if (stages) stages->Add(frame);
    progress.Step();
  });
  progress.End();
  if (stages) stages->Finish(looked.facts, plan, optics, counts);
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
  const RestoreTools tools = OpenTools(options.settings);
  try {
    const auto reader = Opened(options, stop);
    Run(options, optics, tools, *reader, stop);
  } catch (const dataset::Interrupted&) {
    return cli::kExitInterrupted;
  }
  return cli::kExitDone;
}

int PrintPlan(const RestoreOptions& options, const std::atomic<bool>& stop) {
  const std::optional<Optics> optics = OpticsOf(options.optics);
  const Threads threads(options.threads);
  const RestoreTools tools = OpenTools(options.settings);
  try {
    const auto reader = Opened(options, stop);
    FileFrames video(*reader, stop);
    const LookedAt looked = Look(options, optics, tools, video);
    cli::Print(PlanText(looked.facts, PlanFor(looked, options.settings, tools), optics));
  } catch (const dataset::Interrupted&) {
    return cli::kExitInterrupted;
  }
  return cli::kExitDone;
}

}  // namespace shimmer::restore::app
