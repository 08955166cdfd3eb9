#include "restore/app/evaluation/evaluate.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "cli/command_line.h"
#include "cli/error_line.h"
#include "cli/exit_codes.h"
#include "cli/number_text.h"
#include "cli/progress.h"
#include "restore/app/evaluation/clip_run.h"
#include "restore/app/evaluation/pictures.h"
#include "restore/app/evaluation/report_folder.h"
#include "restore/app/evaluation/result_text.h"
#include "restore/app/threads.h"
#include "sim/dataset/interrupted.h"

namespace shimmer::restore::app {
namespace {

namespace fs = std::filesystem;

// A clip, and the variants of it that are not evaluated yet.
struct Task {
  const ClipSet* set;
  size_t clip;
  bool is_real;
  std::vector<const Variant*> variants;

  const std::string& name() const { return set->names()[clip]; }
};

struct Sets {
  std::unique_ptr<ClipSet> truth, real;  // null where there is none
};

Sets OpenSets(const EvaluateOptions& options, const std::atomic<bool>& stop) {
  Sets sets;
  if (options.set.empty() && options.real.empty())
    throw std::invalid_argument("nothing to evaluate: must have a DATASET, or videos after --real");
  if (options.set.empty() && !options.adapter.empty())
    throw std::invalid_argument("--adapter " + options.adapter.string() +
                                ": there is no DATASET that it is of");
  if (!options.set.empty())
    sets.truth = options.adapter.empty() ? OpenDataset(options.set)
                                         : OpenWithAdapter(options.set, options.adapter, stop);
  if (!options.real.empty()) sets.real = OpenRealVideos(options.real, stop);
  if (sets.truth && sets.real)
    for (const std::string& name : sets.real->names())
      if (std::ranges::count(sets.truth->names(), name) > 0)
        throw std::invalid_argument("--real " + name +
                                    ": a clip of the data set has this name, must have another");
  return sets;
}

// Before anything is done: a method's results of all clips are there.
void RequireResults(const std::vector<Variant>& variants, const std::vector<Task>& tasks) {
  for (const Variant& variant : variants) {
    if (variant.kind != VariantKind::kMethod) continue;
    for (const Task& task : tasks)
      if (!task.is_real) FindResults(variant.folder, task.name());
  }
}

std::vector<Task> TasksOf(const EvaluateOptions& options, const Sets& sets) {
  std::vector<Task> tasks;
  const auto add = [&](const ClipSet* set, bool is_real, size_t most) {
    if (!set) return;
    for (size_t i = 0; i < std::min(set->names().size(), most); ++i)
      if (options.shard.Has(static_cast<int64_t>(i))) tasks.push_back({set, i, is_real, {}});
  };
  add(sets.truth.get(), false, options.clips > 0 ? static_cast<size_t>(options.clips) : SIZE_MAX);
  add(sets.real.get(), true, SIZE_MAX);
  return tasks;
}

// What restoring needs, opened once for a thread: a network may be for one at a time.
class ToolChest {
 public:
  const RestoreTools& Of(const Variant& variant) {
    const RestoreSettings& settings = variant.settings;
    const std::string key = settings.flow + "\n" + (settings.sharpen ? settings.model.string() + "\n" : "");
    const auto known = tools_.find(key);
    return known != tools_.end() ? known->second : tools_.emplace(key, OpenTools(settings)).first->second;
  }

 private:
  std::map<std::string, RestoreTools> tools_;
};

class Evaluating {
 public:
  Evaluating(const std::vector<Task>& tasks, ReportFolder& folder, cli::Progress& progress,
             const std::atomic<bool>& stop)
      : tasks_(tasks), folder_(folder), progress_(progress), stop_(stop) {}

  // Takes one clip after the other until there are none; for several threads.
  void Work() {
    ToolChest tools;
    for (size_t i = next_++; i < tasks_.size() && !stop_; i = next_++) Do(tasks_[i], tools);
  }

 private:
  void Do(const Task& task, ToolChest& tools) {
    std::unique_ptr<TrueClip> clip;
    std::string unreadable;
    try {
      clip = task.set->Open(task.clip);
    } catch (const std::exception& error) {
      unreadable = error.what();
    }
    std::optional<ClipRun> run;
    if (clip) run.emplace(*clip, task.is_real, PicturesOf(folder_.path(), task.name()), stop_);
    for (const Variant* variant : task.variants) {
      std::string error = unreadable;
      if (run) try {
          folder_.Put(task.is_real, clip->facts(), variant->name, run->Run(*variant, tools.Of(*variant)));
        } catch (const dataset::Interrupted&) {
          return;
        } catch (const std::exception& caught) {
          error = caught.what();
        }
      if (!error.empty()) folder_.PutError(task.is_real, task.name(), variant->name, error);
      const std::lock_guard guard(mutex_);
      progress_.Step(!error.empty());
    }
  }

  const std::vector<Task>& tasks_;
  ReportFolder& folder_;
  cli::Progress& progress_;
  const std::atomic<bool>& stop_;
  std::atomic<size_t> next_{0};
  std::mutex mutex_;  // of progress_
};

// Each of several threads with its share of all of them for the clip that it is at.
void WorkAtOnce(Evaluating& evaluating, int jobs, int threads) {
  std::vector<std::exception_ptr> thrown(static_cast<size_t>(jobs));
  {
    std::vector<std::jthread> workers;
    for (int job = 0; job < jobs; ++job)
      workers.emplace_back([&, job] {
        try {
          tbb::task_arena(std::max(threads / jobs, 1)).execute([&] { evaluating.Work(); });
        } catch (...) {
          thrown[static_cast<size_t>(job)] = std::current_exception();
        }
      });
  }
  for (const std::exception_ptr& each : thrown)
    if (each) std::rethrow_exception(each);
}

// The first of them; the report has all.
void PrintFailures(const Evaluation& evaluation) {
  std::string first;
  int64_t count = 0;
  for (const auto* clips : {&evaluation.clips, &evaluation.real})
    for (const ClipResult& clip : *clips)
      for (const VariantError& error : clip.errors)
        if (count++ == 0) first = "clip " + clip.facts.name + ", " + error.variant + ": " + error.error;
  if (count == 0) return;
  const std::string more = count > 1 ? " (and " + cli::Counted(count - 1, "other") + " that failed)" : "";
  cli::PrintError("unshimmer", first + more);
}

// Whoever finishes last writes the report of all shards.
void WriteReport(ReportFolder& folder, const EvaluateOptions& options) {
  if (!folder.MayWriteResults()) {
    cli::Print("other shards are still at work: the last one writes the report\n");
    return;
  }
  const Evaluation evaluation = folder.Read();
  folder.WriteResults(evaluation);
  PrintFailures(evaluation);
  cli::Print(ResultsTable(evaluation) + (options.out / "report.html").string() + "\n");
}

int64_t FailuresIn(const std::vector<Task>& tasks, const ReportFolder& folder) {
  int64_t failures = 0;
  for (const Task& task : tasks)
    for (const Variant* variant : task.variants)
      failures += !folder.IsDone(task.is_real, task.name(), variant->name);
  return failures;
}

}  // namespace

int Evaluate(const EvaluateOptions& options, const std::atomic<bool>& stop) {
  const std::vector<Variant> variants = VariantsOf(options.variants);
  ToolChest tools;  // what can't be opened is told before anything is touched
  for (const Variant& variant : variants) tools.Of(variant);
  const Sets sets = OpenSets(options, stop);
  std::vector<Task> tasks = TasksOf(options, sets);
  RequireResults(variants, tasks);
  std::map<std::string, std::string> real;
  if (sets.real)
    for (size_t i = 0; i < options.real.size(); ++i)
      real[sets.real->names()[i]] = fs::absolute(options.real[i]).lexically_normal().string();
  ReportFolder folder(options.out, sets.truth ? sets.truth->Identity() : nullptr, options.set.string(),
                      sets.truth ? sets.truth->count() : 0, variants, real, options.shard);

  int64_t wanted = 0, done = 0;
  for (Task& task : tasks)
    for (const Variant& variant : variants) {
      // Methods and the input have nothing of their own for a video without truth.
      if (task.is_real && (variant.kind == VariantKind::kMethod || variant.kind == VariantKind::kInput))
        continue;
      ++wanted;
      if (folder.IsDone(task.is_real, task.name(), variant.name))
        ++done;
      else
        task.variants.push_back(&variant);
    }
  {
    const Threads limit(options.threads);
    cli::Progress progress("results", wanted, done, options.quiet);
    Evaluating evaluating(tasks, folder, progress, stop);
    WorkAtOnce(evaluating, options.jobs, ThreadCount(options.threads));
  }
  if (stop) return cli::kExitInterrupted;
  WriteReport(folder, options);
  return FailuresIn(tasks, folder) == 0 ? cli::kExitDone : cli::kExitFailed;
}

}  // namespace shimmer::restore::app
