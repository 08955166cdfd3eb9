#include "sim/app/generate.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <iterator>
#include <new>
#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <stdexcept>

#include "sim/app/job.h"
#include "sim/app/make_clip.h"
#include "sim/app/progress.h"

namespace shimmer::app {
namespace {

// A clip on its way: made, or not for one of three reasons.
struct Outcome {
  int64_t clip;
  std::optional<MadeClip> made;
  Json line;
  std::string error;            // its source is bad: noted, and the run goes on
  std::exception_ptr run_ends;  // the machine's fault and not the clip's, which another run may make
  bool interrupted = false;     // the person has asked to stop
};

std::exception_ptr NotEnoughMemory(int64_t clip) {
  return std::make_exception_ptr(std::runtime_error(
      "clip " + std::to_string(clip) + ": not enough memory; fewer --threads, frames or pixels need less"));
}

Outcome TryToMake(const Job& job, int64_t clip, const std::atomic<bool>& stop) {
  Outcome outcome{.clip = clip, .made = {}, .line = Json::object(), .error = "", .run_ends = nullptr};
  try {
    outcome.made = MakeClip(job, clip, stop, outcome.line);
  } catch (const Interrupted&) {
    outcome.interrupted = true;
  } catch (const std::runtime_error& error) {
    outcome.error = error.what();
  } catch (const std::bad_alloc&) {
    outcome.run_ends = NotEnoughMemory(clip);
  } catch (const cv::Exception& error) {
    if (error.code == cv::Error::StsNoMem)
      outcome.run_ends = NotEnoughMemory(clip);
    else
      outcome.error = error.what();
  } catch (...) {
    outcome.run_ends = std::current_exception();
  }
  // Asked to stop, a read may break off: that is no fault of its source.
  if (stop && !outcome.made) outcome.interrupted = true;
  return outcome;
}

std::vector<int64_t> ClipsToMake(const GenerateOptions& options, int64_t clips,
                                 const dataset::DatasetWriter& writer) {
  const std::set<int64_t> done = writer.done(), failed = writer.failed();
  std::vector<int64_t> pending;
  if (options.only_clips.empty()) {
    for (int64_t clip = 0; clip < clips; ++clip)
      if (!done.contains(clip) && !failed.contains(clip)) pending.push_back(clip);
  } else {  // a failed clip that is asked for by its number is tried again
    for (int64_t clip : std::set<int64_t>(options.only_clips.begin(), options.only_clips.end()))
      if (!done.contains(clip)) pending.push_back(clip);
  }
  return pending;
}

void RequireClips(const std::vector<int64_t>& only_clips, int64_t clips) {
  for (int64_t clip : only_clips)
    if (clip < 0 || clip >= clips)
      throw std::invalid_argument("--clip " + std::to_string(clip) + ": must be in [0, " +
                                  std::to_string(clips - 1) + "]");
}

// The folder may hold more clips than the config asks for: an earlier run's `clips` may have been larger.
int64_t CountBelow(int64_t end, const std::set<int64_t>& clips) {
  return std::distance(clips.begin(), clips.lower_bound(end));
}

}  // namespace

int Generate(const GenerateOptions& options, const std::atomic<bool>& stop) {
  if (options.out.empty()) throw std::invalid_argument("--out: is empty, must be a folder");
  const Job job = Job::Load(options.config, options.sets, options.out);
  const int64_t clips = job.config.fixed().clips;
  RequireClips(options.only_clips, clips);
  dataset::DatasetWriter writer(options.out, job.Layout(), job.Description());
  const std::vector<int64_t> pending = ClipsToMake(options, clips, writer);

  const auto threads = options.threads > 0 ? static_cast<size_t>(options.threads)
                                           : static_cast<size_t>(tbb::info::default_concurrency());
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const auto finished = static_cast<int64_t>(writer.done().size());
  Progress progress(finished + static_cast<int64_t>(pending.size()), finished, options.quiet);
  const auto start = std::chrono::steady_clock::now();

  // Clips are made on all threads and written in their order, so that the manifest is the same however many
  // there are.
  size_t next = 0;
  std::atomic<bool> ended{false};  // nothing is kept after a clip that is not, or the order would be another
  const auto give_clip = [&](tbb::flow_control& flow) -> int64_t {
    if (stop || ended || next == pending.size()) return flow.stop(), 0;
    return pending[next++];
  };
  // Isolated: a thread that waits for the rows of its clip shall not begin another clip meanwhile.
  const auto make = [&](int64_t clip) {
    return tbb::this_task_arena::isolate([&] { return TryToMake(job, clip, stop); });
  };
  std::string first_error;
  const auto keep = [&](Outcome& outcome) {
    if (outcome.run_ends) std::rethrow_exception(outcome.run_ends);
    if (outcome.made) {
      writer.Commit(outcome.clip, outcome.made->files, std::move(outcome.made->line));
    } else {
      outcome.line["error"] = outcome.error;
      if (first_error.empty()) first_error = outcome.error;
      writer.Fail(outcome.clip, std::move(outcome.line));
    }
    progress.Clip(!outcome.made);
  };
  std::exception_ptr error;  // not thrown through the pipeline, which would lose the clips that are in it
  const auto write = [&](Outcome outcome) {
    ended = ended || outcome.interrupted;
    if (ended) return;
    try {
      keep(outcome);
    } catch (...) {
      error = std::current_exception();
      ended = true;
    }
  };
  tbb::parallel_pipeline(threads + 1,
                         tbb::make_filter<void, int64_t>(tbb::filter_mode::serial_in_order, give_clip) &
                             tbb::make_filter<int64_t, Outcome>(tbb::filter_mode::parallel, make) &
                             tbb::make_filter<Outcome, void>(tbb::filter_mode::serial_in_order, write));
  progress.End();
  if (error) std::rethrow_exception(error);

  const int64_t done = CountBelow(clips, writer.done()), failed = CountBelow(clips, writer.failed());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.quiet)
    std::printf("%s: %lld of %lld clips done, %lld failed (%s)\n", options.out.c_str(),
                static_cast<long long>(done), static_cast<long long>(clips), static_cast<long long>(failed),
                DurationText(seconds).c_str());
  if (stop) return kExitInterrupted;
  if (failed > 0)
    std::fprintf(stderr, "shimmer: %s: %lld clips failed, %s; \"error\" of their lines says why\n",
                 (options.out / "manifest.jsonl").c_str(), static_cast<long long>(failed),
                 first_error.empty() ? "all in an earlier run" : ("the first with: " + first_error).c_str());
  return failed > 0 ? kExitFailed : kExitDone;
}

}  // namespace shimmer::app
