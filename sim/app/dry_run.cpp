#include "sim/app/dry_run.h"

#include <sys/statvfs.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "cli/exit_codes.h"
#include "cli/number_text.h"
#include "cli/progress.h"
#include "sim/app/job.h"
#include "sim/app/make_clip.h"
#include "sim/dataset/dataset_difference.h"
#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/manifest.h"
#include "sim/dataset/pending.h"

namespace shimmer::app {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kMostFlatFiles = 200'000;
constexpr double kMostSampleSeconds = 10;  // after which no further clip is begun

struct FreeSpace {
  double bytes;
  std::optional<double> files;  // none: the file system has no such limit
  int64_t block_bytes;
};

// Of the file system that the folder is in or would be in.
FreeSpace FreeSpaceAt(const fs::path& folder) {
  fs::path there = fs::absolute(folder);
  while (!fs::exists(there) && there.has_relative_path()) there = there.parent_path();
  struct statvfs status = {};
  if (statvfs(there.c_str(), &status) != 0)
    throw std::runtime_error(there.string() + ": its free space can't be read");
  const auto block = static_cast<double>(status.f_frsize);
  return {.bytes = static_cast<double>(status.f_bavail) * block,
          .files = status.f_files > 0 ? std::optional(static_cast<double>(status.f_favail)) : std::nullopt,
          .block_bytes = std::max<int64_t>(1, static_cast<int64_t>(status.f_bsize))};
}

// What the folder holds already, without opening it for writing.
dataset::Manifest ManifestOfTarget(const fs::path& folder, const Json& description) {
  if (fs::exists(folder / dataset::kDescriptionName)) {
    const auto differences = dataset::Differences(dataset::ReadDescription(folder), description);
    if (!differences.empty())
      throw std::invalid_argument(folder.string() + ": holds a data set made from something else: " +
                                  dataset::InOneLine(differences));
  }
  return dataset::Manifest(dataset::ManifestsIn(folder));
}

struct Samples {
  int64_t clips = 0, failed = 0;
  double files = 0, bytes = 0, disk_bytes = 0, seconds = 0;  // of all of them
};

// A few clips, spread over those that are to be made.
Samples MakeSamples(const Job& job, const std::vector<int64_t>& pending, int threads, int64_t block_bytes,
                    const std::atomic<bool>& stop) {
  const auto count = std::min<int64_t>(static_cast<int64_t>(pending.size()), 4 * threads);
  Samples samples;
  std::mutex mutex;
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  tbb::parallel_for(int64_t{0}, count, [&](int64_t i) {
    if (stop || seconds() > kMostSampleSeconds) return;
    double files = 0, bytes = 0, disk_bytes = 0;
    const auto add = [&](int64_t file_bytes) {
      bytes += static_cast<double>(file_bytes);
      disk_bytes += static_cast<double>((file_bytes + block_bytes - 1) / block_bytes * block_bytes);
    };
    bool failed = false;
    Json line;
    try {
      const int64_t clip = pending[static_cast<size_t>(i * static_cast<int64_t>(pending.size()) / count)];
      tbb::this_task_arena::isolate([&] {
        MakeClip(
            job, clip, stop,
            [&](const dataset::ClipFile& file) {
              ++files;
              add(static_cast<int64_t>(file.bytes.size()));
            },
            line);
      });
    } catch (const Interrupted&) {
      return;
    } catch (const std::runtime_error&) {
      failed = true;  // of the source; the run would note it and go on
    }
    // The manifest's line names each file with two hashes.
    bytes +=
        static_cast<double>(line.dump(-1, ' ', false, Json::error_handler_t::replace).size()) + files * 250;
    const std::lock_guard guard(mutex);
    ++samples.clips;
    samples.failed += failed;
    samples.files += files;
    samples.bytes += bytes;
    samples.disk_bytes += disk_bytes;
  });
  samples.seconds = seconds();
  return samples;
}

void Print(const char* what, const std::string& text) { std::printf("%-9s %s\n", what, text.c_str()); }

}  // namespace

int DryRun(const GenerateOptions& options, const std::atomic<bool>& stop) {
  const Job job = Job::Load(options.config, options.sets, options.out, stop);
  const Config& fixed = job.config.fixed();
  const dataset::Layout layout = job.Layout();
  const dataset::Manifest there = ManifestOfTarget(options.out, job.Description());
  const std::vector<int64_t> pending =
      dataset::PendingClips(layout, options.WantedOf(fixed.clips), there.done(), there.failed());
  const FreeSpace free = FreeSpaceAt(options.out);
  job.pictures->SetBudget(
      static_cast<uint64_t>(PlanMemory(options.memory_bytes, job.config, 1).sources_bytes));
  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const Samples samples = MakeSamples(job, pending, threads, free.block_bytes, stop);
  if (stop) return cli::kExitInterrupted;

  const auto clips = static_cast<double>(pending.size()),
             made = std::max(1.0, static_cast<double>(samples.clips));
  const double bytes = samples.disk_bytes / made * clips;
  double files = samples.files / made * clips;
  if (layout.IsTars())
    files = static_cast<double>((pending.size() + layout.clips_per_tar - 1) / layout.clips_per_tar);
  const std::string from = ", from " + cli::Counted(samples.clips, "clip") + ")";
  Print("clips", cli::Grouped(static_cast<int64_t>(pending.size())) + " of " + cli::Grouped(fixed.clips));
  Print("frames", cli::Grouped(static_cast<int64_t>(pending.size()) * KeptFrameCount(fixed)));
  Print("files", cli::Grouped(std::llround(files)));
  Print("bytes", cli::BytesText(static_cast<uint64_t>(bytes)) + " (" +
                     cli::BytesText(static_cast<uint64_t>(samples.bytes / made)) + " a clip" + from);
  char rate[40];
  std::snprintf(rate, sizeof rate, "%.3g", made / std::max(samples.seconds, 1e-9));
  Print("time", cli::DurationText(samples.seconds / made * clips) + " (" + rate + " clips/s on " +
                    std::to_string(threads) + (threads == 1 ? " thread" : " threads") + from);
  Print("free", cli::BytesText(static_cast<uint64_t>(free.bytes)) +
                    (free.files ? ", " + cli::Grouped(std::llround(*free.files)) + " files" : ""));
  if (samples.failed > 0)
    Print("warning", cli::Grouped(samples.failed) + " of " + cli::Grouped(samples.clips) +
                         " clips failed, for their sources are bad");
  const double all_files = files / std::max(1.0, clips) * static_cast<double>(fixed.clips);
  if (layout.IsPairs() && all_files > kMostFlatFiles)
    Print("warning", cli::Grouped(std::llround(all_files)) +
                         " files in a few flat folders, as the readers of this layout want "
                         "them; beyond 200,000 many file systems get slow (sequence, basicsr and webdataset "
                         "are not flat)");
  std::fflush(stdout);
  if (bytes > free.bytes)
    throw std::runtime_error(
        options.out.string() + ": would take " + cli::BytesText(static_cast<uint64_t>(bytes)) + ", but " +
        cli::BytesText(static_cast<uint64_t>(free.bytes)) + " are free; fewer clips, or another --out");
  if (free.files && files > *free.files)
    throw std::runtime_error(options.out.string() + ": would take " + cli::Grouped(std::llround(files)) +
                             " files, but " + cli::Grouped(std::llround(*free.files)) +
                             " can be made there; output.layout=webdataset makes few");
  return cli::kExitDone;
}

}  // namespace shimmer::app
