#include "sim/app/verify.h"

#include <tbb/info.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "cli/exit_codes.h"
#include "cli/number_text.h"
#include "sim/app/repair.h"
#include "sim/dataset/dataset_folder.h"
#include "sim/dataset/folder_lock.h"
#include "sim/dataset/interrupted.h"

namespace shimmer::app {
namespace {

namespace fs = std::filesystem;

// One line, whatever bytes a file's name has.
void PrintLine(std::string line) {
  std::ranges::replace_if(
      line, [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  std::printf("%s\n", line.c_str());
}

void Print(const VerifyOptions& options, const VerifiedSet& found) {
  if (!options.quiet)
    for (const dataset::Problem& problem : found.problems) PrintLine(problem.name + ": " + problem.text);
  const std::string failed = found.failed > 0 ? cli::Grouped(found.failed) + " failed, " : "";
  PrintLine(options.folder.string() + ": " + cli::Grouped(found.whole) + " of " +
            cli::Counted(found.clips, "clip") + " whole, " + failed + cli::Counted(found.files, "file") +
            ", " + cli::Counted(std::ssize(found.problems), "problem"));
}

int VerifyAndRepair(const VerifyOptions& options, const std::atomic<bool>& stop) {
  if (!fs::exists(options.folder / dataset::kDescriptionName))
    throw std::invalid_argument(options.folder.string() + ": not a data set (no " +
                                dataset::kDescriptionName + " in it)");
  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const auto verify = [&](const VerifiedSet* before) {
    const auto lock = dataset::LockToRead(options.folder);
    return VerifySet(options.folder, before, threads, options.quiet, stop);
  };
  VerifiedSet found = verify(nullptr);
  if (stop) return cli::kExitInterrupted;
  Print(options, found);
  if (options.repair && !found.problems.empty()) {
    std::fflush(stdout);  // before what may be said on stderr
    const Repaired repaired =
        Repair(options.folder, found, options.config_folder, threads, options.quiet, stop);
    for (const auto* lines : {&repaired.moved, &repaired.errors})
      for (const std::string& line : *lines)
        if (!options.quiet) PrintLine(line);
    PrintLine(options.folder.string() + ": " + cli::Counted(repaired.clips_made, "clip") + " made again, " +
              cli::Counted(std::ssize(repaired.moved), "file") + " moved to " + dataset::kSurplusName);
    if (stop) return cli::kExitInterrupted;
    found = verify(&found);
    if (stop) return cli::kExitInterrupted;
    Print(options, found);
  }
  return found.problems.empty() && found.failed == 0 ? cli::kExitDone : cli::kExitFailed;
}

}  // namespace

int Verify(const VerifyOptions& options, const std::atomic<bool>& stop) {
  try {
    return VerifyAndRepair(options, stop);
  } catch (const dataset::Interrupted&) {
    return cli::kExitInterrupted;
  }
}

}  // namespace shimmer::app
