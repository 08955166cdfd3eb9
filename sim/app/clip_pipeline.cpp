#include "sim/app/clip_pipeline.h"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <exception>
#include <new>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "sim/app/make_clip.h"

namespace shimmer::app {
namespace {

// A clip on its way: made or failed, or neither for one of two reasons.
struct Outcome {
  MadeClip made;
  std::exception_ptr run_ends =
      nullptr;               // the machine's fault and not the clip's, which another run may make
  bool interrupted = false;  // the person has asked to stop
};

std::exception_ptr NotEnoughMemory(int64_t clip) {
  return std::make_exception_ptr(std::runtime_error(
      "clip " + std::to_string(clip) + ": not enough memory; fewer --threads or pixels need less"));
}

Outcome TryToMake(const Job& job, int64_t clip, const dataset::DatasetWriter& writer,
                  const std::atomic<bool>& stop) {
  Outcome outcome{.made = {.clip = clip, .staged = {}, .line = Json::object(), .error = ""}};
  MadeClip& made = outcome.made;
  try {
    dataset::StagedClip staged = writer.Stage(clip);
    MakeClip(
        job, clip, stop, [&](const dataset::ClipFile& file) { staged.Add(file); }, made.line);
    made.staged = std::move(staged);
  } catch (const Interrupted&) {
    outcome.interrupted = true;
  } catch (const dataset::TargetError&) {
    outcome.run_ends = std::current_exception();
  } catch (const std::runtime_error& error) {
    made.error = error.what();
  } catch (const std::bad_alloc&) {
    outcome.run_ends = NotEnoughMemory(clip);
  } catch (const cv::Exception& error) {
    if (error.code == cv::Error::StsNoMem)
      outcome.run_ends = NotEnoughMemory(clip);
    else
      made.error = error.what();
  } catch (...) {
    outcome.run_ends = std::current_exception();
  }
  // Asked to stop, a read may break off: that is no fault of its source.
  if (stop && !made.staged) outcome.interrupted = true;
  return outcome;
}

}  // namespace

void MakeClips(const Job& job, std::span<const int64_t> clips, const dataset::DatasetWriter& writer,
               PipelineLimits limits, const std::atomic<bool>& stop,
               const std::function<void(MadeClip)>& keep) {
  const auto threads = static_cast<size_t>(limits.threads),
             at_once = static_cast<size_t>(limits.clips_at_once);
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  size_t next = 0;
  std::atomic<bool> ended{false};  // nothing is kept after a clip that is not, or the order would be another
  const auto give_clip = [&](tbb::flow_control& flow) -> int64_t {
    if (stop || ended || next == clips.size()) return flow.stop(), 0;
    return clips[next++];
  };
  // Isolated: a thread that waits for the rows of its clip shall not begin another clip meanwhile.
  const auto make = [&](int64_t clip) {
    return tbb::this_task_arena::isolate(
        [&] { return std::make_shared<Outcome>(TryToMake(job, clip, writer, stop)); });
  };
  std::exception_ptr error;  // not thrown through the pipeline, which would lose the clips that are in it
  const auto hand_on = [&](const std::shared_ptr<Outcome>& outcome) {
    ended = ended || outcome->interrupted;
    if (ended) return;
    try {
      if (outcome->run_ends) std::rethrow_exception(outcome->run_ends);
      keep(std::move(outcome->made));
    } catch (...) {
      error = std::current_exception();
      ended = true;
    }
  };
  // A clip that is made waits on disk for those before it, so that slow ones hold up nobody.
  const size_t tokens = at_once < threads ? at_once : 2 * threads + 1;
  using Made = std::shared_ptr<Outcome>;
  tbb::parallel_pipeline(tokens,
                         tbb::make_filter<void, int64_t>(tbb::filter_mode::serial_in_order, give_clip) &
                             tbb::make_filter<int64_t, Made>(tbb::filter_mode::parallel, make) &
                             tbb::make_filter<Made, void>(tbb::filter_mode::serial_in_order, hand_on));
  if (error) std::rethrow_exception(error);
}

void MakeClipsDurably(const Job& job, std::span<const int64_t> clips, dataset::DatasetWriter& writer,
                      PipelineLimits limits, const std::atomic<bool>& stop,
                      const std::function<void(MadeClip)>& keep) {
  std::exception_ptr error;
  try {
    MakeClips(job, clips, writer, limits, stop, keep);
  } catch (...) {
    error = std::current_exception();
  }
  try {
    writer.Flush();
  } catch (...) {
    if (!error) error = std::current_exception();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace shimmer::app
