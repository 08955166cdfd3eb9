#include "sim/app/verified_set.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <mutex>
#include <tuple>

#include "cli/progress.h"
#include "sim/app/job.h"
#include "sim/dataset/dataset_folder.h"

namespace shimmer::app {
namespace {

namespace fs = std::filesystem;
using dataset::Contents;
using dataset::Problem;
using dataset::ProblemKind;

// A damaged line as the manifest's reader tells it, "FOLDER/manifest.jsonl:3: damaged line (...)".
Problem DamagedLine(const fs::path& folder, const std::string& what) {
  const std::string text = what.substr((folder / "").string().size());
  const size_t end = text.find(": ");
  return {ProblemKind::kManifest, text.substr(0, end), text.substr(end + 2)};
}

// dataset.json against what its config means.
std::vector<Problem> VerifyDescription(const fs::path& folder, const Json& description,
                                       const ConfigFile& config, const dataset::Layout& right) {
  std::vector<Problem> problems;
  const auto add = [&](const std::string& text) {
    problems.push_back({ProblemKind::kDescription, dataset::kDescriptionName, text});
  };
  if (description.value("config_hash", Json()) != config.Hash())
    add("damaged: config_hash is not that of its config");
  const dataset::Layout there = LayoutOfDataset(folder, description);
  if (there.digits != right.digits)
    add("damaged: pair_digits is " + std::to_string(there.digits) + ", must be " +
        std::to_string(right.digits));
  if (there.clips_per_tar != right.clips_per_tar && right.IsTars())
    add("damaged: clips_per_tar is " + std::to_string(there.clips_per_tar) + ", must be " +
        std::to_string(right.clips_per_tar));
  return problems;
}

// What was looked at is added to found.
void VerifyUnits(const Contents& contents, const std::vector<int64_t>& units, int threads, bool quiet,
                 const std::atomic<bool>& stop, VerifiedSet& found) {
  const std::set<int64_t>& done = contents.set.clips();
  const auto clips_in = [&](int64_t unit) {
    const int64_t begin = unit * contents.layout.ClipsPerUnit();
    return std::distance(done.lower_bound(begin), done.lower_bound(begin + contents.layout.ClipsPerUnit()));
  };
  int64_t clips = 0;
  for (const int64_t unit : units) clips += clips_in(unit);
  cli::Progress progress("clips", clips, 0, quiet);
  std::mutex mutex;  // of progress and found
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  tbb::parallel_for(size_t{0}, units.size(), [&](size_t i) {
    if (stop) return;
    dataset::UnitFindings unit = dataset::VerifyUnit(contents, units[i]);
    const std::lock_guard guard(mutex);
    std::ranges::move(unit.problems, std::back_inserter(found.problems));
    found.one_clean.insert(unit.one_clean.begin(), unit.one_clean.end());
    for (int64_t clip = 0; clip < clips_in(units[i]); ++clip) progress.Step(false);
  });
}

void Count(const Contents& contents, VerifiedSet& found) {
  const std::set<int64_t>& done = contents.set.clips();
  std::set<int64_t> not_whole;
  for (const Problem& problem : found.problems)
    if (problem.clips)
      not_whole.insert(done.lower_bound(problem.clips->first), done.upper_bound(problem.clips->last));
  const auto below = [&](const std::set<int64_t>& clips) {
    return std::distance(clips.begin(), clips.lower_bound(contents.clips));
  };
  const auto done_count = static_cast<int64_t>(done.size()), one_clean = std::ssize(found.one_clean);
  found.clips = contents.clips + done_count - below(done);
  found.whole = done_count - std::ssize(not_whole);
  found.failed = below(contents.set.failed());
  found.files = contents.layout.IsTars() ? done_count : 0;
  for (const dataset::FrameKind kind : dataset::kFrameKinds)
    found.files +=
        one_clean * contents.FilesOf(kind, true) + (done_count - one_clean) * contents.FilesOf(kind, false);
}

}  // namespace

VerifiedSet VerifySet(const fs::path& folder, const VerifiedSet* before, int threads, bool quiet,
                      const std::atomic<bool>& stop) {
  VerifiedSet found;
  const dataset::DatasetReader set(
      folder, [&](const std::string& what) { found.problems.push_back(DamagedLine(folder, what)); });
  const ConfigFile config = ConfigOfDataset(folder, set.description());
  const Contents contents{.set = set,
                          .layout = LayoutOfConfig(config),
                          .clips = config.fixed().clips,
                          .frames = KeptFrameCount(config.fixed()),
                          .truth = dataset::TruthKinds(config.fixed().output.truth)};
  std::ranges::move(VerifyDescription(folder, set.description(), config, contents.layout),
                    std::back_inserter(found.problems));

  std::set<int64_t> units;
  const auto want = [&](int64_t first_clip, int64_t last_clip) {
    for (auto clip = set.clips().lower_bound(first_clip); clip != set.clips().upper_bound(last_clip); ++clip)
      units.insert(contents.layout.UnitOf(*clip));
  };
  if (before) {
    for (const Problem& problem : before->problems)
      if (problem.clips) want(problem.clips->first, problem.clips->last);
    found.one_clean = before->one_clean;
    for (const int64_t unit : units)
      for (int64_t i = 0; i < contents.layout.ClipsPerUnit(); ++i)
        found.one_clean.erase(unit * contents.layout.ClipsPerUnit() + i);
  } else {
    want(0, INT64_MAX);
  }
  VerifyUnits(contents, {units.begin(), units.end()}, threads, quiet, stop, found);
  if (stop) return found;
  dataset::NameSwapped(set, found.problems);
  std::ranges::move(dataset::VerifyManifest(contents, found.problems), std::back_inserter(found.problems));
  std::ranges::move(dataset::FindSurplus(contents, found.one_clean), std::back_inserter(found.problems));
  std::ranges::sort(found.problems, {}, [](const Problem& problem) {
    return std::tuple(problem.clips ? problem.clips->first : INT64_MAX, std::cref(problem.name).get());
  });
  Count(contents, found);
  return found;
}

}  // namespace shimmer::app
