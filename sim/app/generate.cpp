#include "sim/app/generate.h"

#include <tbb/info.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "cli/error_line.h"
#include "cli/exit_codes.h"
#include "cli/progress.h"
#include "sim/app/clip_pipeline.h"
#include "sim/app/dry_run.h"
#include "sim/app/finish.h"
#include "sim/app/job.h"
#include "sim/app/origin.h"

namespace shimmer::app {
namespace {

// Waits for another writer if the person wants that.
std::unique_ptr<dataset::DatasetWriter> OpenFolder(const GenerateOptions& options, const Job& job,
                                                   const std::atomic<bool>& stop) {
  std::unique_ptr<dataset::DatasetWriter> writer;
  while (!writer && !stop) {
    try {
      writer = std::make_unique<dataset::DatasetWriter>(options.out, job.Layout(), job.Description(),
                                                        options.shard);
    } catch (const dataset::FolderBusy&) {
      if (!options.wait) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
    }
  }
  return writer;
}

// Of this shard, and below the config's number: the folder may hold more, for an earlier run's `clips` may
// have been larger.
struct Count {
  int64_t clips = 0, done = 0, failed = 0;
};

Count CountClips(const dataset::DatasetWriter& writer, int64_t clips, const dataset::Shard& shard) {
  const std::set<int64_t> done = writer.done(), failed = writer.failed();
  Count count;
  for (int64_t clip = 0; clip < clips; ++clip) {
    if (!shard.Has(writer.layout().UnitOf(clip))) continue;
    ++count.clips;
    count.done += done.contains(clip);
    count.failed += failed.contains(clip);
  }
  return count;
}

std::string Summary(const GenerateOptions& options, const Count& count, double seconds) {
  const std::string shard = options.shard.whole() ? ""
                                                  : ": shard " + std::to_string(options.shard.index) + "/" +
                                                        std::to_string(options.shard.count);
  return options.out.string() + shard + ": " + std::to_string(count.done) + " of " +
         std::to_string(count.clips) + " clips done, " + std::to_string(count.failed) + " failed (" +
         cli::DurationText(seconds) + ")";
}

}  // namespace

dataset::Wanted GenerateOptions::WantedOf(int64_t clips) const {
  for (const int64_t clip : only_clips)
    if (clip < 0 || clip >= clips)
      throw std::invalid_argument("--clip " + std::to_string(clip) + ": must be in [0, " +
                                  std::to_string(clips - 1) + "]");
  return {.clips = clips, .shard = shard, .retry_failed = retry_failed, .only = only_clips};
}

namespace {

int MakeMissingClips(const GenerateOptions& options, const std::atomic<bool>& stop) {
  Job job = Job::Load(options.config, options.sets, options.out, stop);
  const int64_t clips = job.config.fixed().clips;
  const dataset::Wanted wanted = options.WantedOf(clips);
  const auto start = std::chrono::steady_clock::now();
  const std::unique_ptr<dataset::DatasetWriter> writer = OpenFolder(options, job, stop);
  if (!writer) return cli::kExitInterrupted;
  job.RememberSources(options.out);
  if (job.FromFiles()) NoteConfigFolder(options.out, options.config.parent_path());
  const std::vector<int64_t> pending =
      dataset::PendingClips(writer->layout(), wanted, writer->done(), writer->failed());

  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const MemoryPlan memory = PlanMemory(options.memory_bytes, job.config, threads);
  job.pictures->SetBudget(static_cast<uint64_t>(memory.sources_bytes));
  const int64_t own = CountClips(*writer, clips, options.shard).clips;
  const auto to_make = std::ranges::count_if(pending, [&](int64_t clip) { return clip < clips; });
  cli::Progress progress("clips", own, own - to_make, options.quiet);
  std::string first_error, first_kept;
  const std::set<int64_t> were_done = writer->done();
  std::set<int64_t> kept_units;
  const auto keep = [&](MadeClip made) {
    const bool failed = !made.staged;
    if (failed && were_done.contains(made.clip)) {
      // Of a tar that is to be made again: the one that is there stays, for without this clip the writer
      // never has all of it
      kept_units.insert(writer->layout().UnitOf(made.clip));
      if (first_kept.empty())
        first_kept = "clip " + std::to_string(made.clip) + " can't be made again: " + made.error;
    } else if (failed) {
      made.line["error"] = made.error;
      if (first_error.empty()) first_error = made.error;
      writer->Fail(made.clip, std::move(made.line));
    } else {
      writer->Commit(std::move(*made.staged), std::move(made.line));
    }
    progress.Step(failed);
  };
  MakeClipsDurably(job, pending, *writer, {.threads = threads, .clips_at_once = memory.clips_at_once}, stop,
                   keep);
  progress.End();

  const Count count = CountClips(*writer, clips, options.shard);
  if (options.shard.whole() && !stop && !(pending.empty() && IsFinished(options.out)))
    FinishDataset(options.out, writer->layout());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.quiet) std::printf("%s\n", Summary(options, count, seconds).c_str());
  if (stop) return cli::kExitInterrupted;
  std::vector<std::string> wrong;
  if (count.failed > 0)
    wrong.push_back((options.out / ("manifest" + options.shard.Suffix() + ".jsonl")).string() + ": " +
                    std::to_string(count.failed) + " clips failed, " +
                    (first_error.empty() ? "all in an earlier run" : "the first with: " + first_error) +
                    "; \"error\" of their lines says why");
  if (!kept_units.empty())
    wrong.push_back((options.out / writer->layout().TarPath(*kept_units.begin())).string() +
                    (kept_units.size() > 1 ? " and " + std::to_string(kept_units.size() - 1) + " more" : "") +
                    ": left as it is, for " + first_kept);
  if (wrong.empty()) return cli::kExitDone;
  cli::PrintError("shimmer", wrong.size() > 1 ? wrong[0] + "; " + wrong[1] : wrong[0]);
  return cli::kExitFailed;
}

}  // namespace

int Generate(const GenerateOptions& options, const std::atomic<bool>& stop) {
  if (options.out.empty()) throw std::invalid_argument("--out: is empty, must be a folder");
  options.shard.Validate();
  try {
    return options.dry_run ? DryRun(options, stop) : MakeMissingClips(options, stop);
  } catch (const dataset::Interrupted&) {
    return cli::kExitInterrupted;
  }
}

}  // namespace shimmer::app
