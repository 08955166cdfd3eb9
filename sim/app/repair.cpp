#include "sim/app/repair.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "cli/progress.h"
#include "sim/app/clip_pipeline.h"
#include "sim/app/clip_size.h"
#include "sim/app/finish.h"
#include "sim/app/job.h"
#include "sim/app/origin.h"
#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/pending.h"
#include "sim/dataset/unite.h"

namespace shimmer::app {
namespace {

namespace fs = std::filesystem;
using dataset::Problem;
using dataset::ProblemKind;

// Damaged lines are left out: the clips that miss them are made again.
void LeaveOut(const std::string&) {}

Job JobOf(const fs::path& folder, const Json& description, const fs::path& config_folder,
          const std::atomic<bool>& stop) {
  const bool drawn = !ConfigOfDataset(folder, description).fixed().source.FromFiles();
  return Job::OfDataset(folder, description,
                        drawn || !config_folder.empty() ? config_folder : NotedConfigFolder(folder), stop);
}

// Those that are to be made again, and whatever stands in a tar with them.
std::vector<int64_t> ClipsToMake(const fs::path& folder, const VerifiedSet& found, const Job& job) {
  const dataset::DatasetReader set(folder, LeaveOut);
  const dataset::Layout layout = job.Layout();
  const int64_t clips = job.config.fixed().clips;
  std::vector<int64_t> wanted;
  for (const Problem& problem : found.problems) {
    if (!problem.clips) continue;
    const auto [first, last] = *problem.clips;
    for (int64_t clip = first; clip <= std::min(last, clips - 1); ++clip) wanted.push_back(clip);
    // There may be more than the config says: an earlier run's `clips` may have been larger.
    if (last < clips) continue;
    const auto end = set.clips().upper_bound(last);
    for (auto clip = set.clips().lower_bound(std::max(first, clips)); clip != end; ++clip)
      wanted.push_back(*clip);
  }
  if (wanted.empty()) return {};
  const int64_t end = std::max(clips, *std::ranges::max_element(wanted) + 1);
  if (layout.IsTars() && end > clips)
    throw std::runtime_error(folder.string() +
                             ": can't be made again: " + layout.TarPath(layout.UnitOf(end - 1)) +
                             " holds clip " + std::to_string(end - 1) + ", and `clips` is " +
                             std::to_string(clips) + "; generate with more clips first");
  std::set<int64_t> whole = set.clips();
  for (const int64_t clip : wanted) whole.erase(clip);
  return dataset::PendingClips(layout,
                               {.clips = end, .shard = {}, .retry_failed = false, .only = std::move(wanted)},
                               whole, set.failed());
}

// The manifest as one file with a line a clip, in their order.
void TidyManifest(const fs::path& folder) {
  dataset::UniteManifests(folder, dataset::FolderLock(folder, {}), LeaveOut);
}

void MakeAgain(const fs::path& folder, const Job& job, const std::vector<int64_t>& clips, int threads,
               bool quiet, const std::atomic<bool>& stop, Repaired& repaired) {
  dataset::DatasetWriter writer(folder, job.Layout(), job.Description());
  const std::set<int64_t> were_done = writer.done();
  const MemoryPlan memory = PlanMemory(kDefaultMemory_bytes, job.config, threads);
  job.pictures->SetBudget(static_cast<uint64_t>(memory.sources_bytes));
  cli::Progress progress("clips", std::ssize(clips), 0, quiet);
  const auto keep = [&](MadeClip made) {
    const bool failed = !made.staged;
    if (failed && were_done.contains(made.clip)) {
      repaired.errors.push_back("clip " + std::to_string(made.clip) + ": can't be made again: " + made.error);
    } else if (failed) {
      made.line["error"] = made.error;
      writer.Fail(made.clip, std::move(made.line));
    } else {
      ++repaired.clips_made;
      if (writer.layout().IsTars())
        writer.Commit(std::move(*made.staged), std::move(made.line));
      else
        writer.Repair(std::move(*made.staged), std::move(made.line));
    }
    progress.Step(failed);
  };
  MakeClipsDurably(job, clips, writer, {.threads = threads, .clips_at_once = memory.clips_at_once}, stop,
                   keep);
}

}  // namespace

Repaired Repair(const fs::path& folder, const VerifiedSet& found, const fs::path& config_folder, int threads,
                bool quiet, const std::atomic<bool>& stop) {
  const auto has = [&](ProblemKind kind) {
    return std::ranges::any_of(found.problems, [&](const Problem& problem) { return problem.kind == kind; });
  };
  if (has(ProblemKind::kDescription))
    throw std::runtime_error((folder / dataset::kDescriptionName).string() +
                             ": is damaged, and nothing says what it was; can't be made again");
  const bool clips_wanted =
      std::ranges::any_of(found.problems, [](const Problem& problem) { return problem.clips.has_value(); });
  std::optional<Job> job;
  std::vector<int64_t> clips;
  if (clips_wanted) {
    job = JobOf(folder, dataset::ReadDescription(folder), config_folder, stop);
    clips = ClipsToMake(folder, found, *job);
  }

  Repaired repaired;
  {
    const dataset::FolderLock lock(folder, {});
    for (const Problem& problem : found.problems) {
      const bool moves = problem.kind == ProblemKind::kSurplus || problem.kind == ProblemKind::kInTheWay;
      if (!moves || problem.name.starts_with(dataset::kStagingName)) continue;
      if (!fs::exists(fs::symlink_status(folder / problem.name))) continue;  // went with its folder
      repaired.moved.push_back(problem.name + ": moved to " + dataset::MoveToSurplus(folder, problem.name));
    }
  }
  // A line that shards have written would count for more than one that is written now.
  if (has(ProblemKind::kManifest) || dataset::ManifestsIn(folder).size() > 1) TidyManifest(folder);
  const Json description = dataset::ReadDescription(folder);
  const dataset::Layout layout = LayoutOfDataset(folder, description);
  if (!job) {
    const dataset::DatasetWriter cleaner(folder, layout, description);  // of what kills have left
  } else {
    MakeAgain(folder, *job, clips, threads, quiet, stop, repaired);
    if (stop) return repaired;
    TidyManifest(folder);
  }
  // Of clips that are damaged still, no report can be drawn.
  if (repaired.errors.empty()) FinishDataset(folder, layout);
  return repaired;
}

}  // namespace shimmer::app
