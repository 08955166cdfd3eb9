#include "restore/app/compare.h"

#include "cli/command_line.h"
#include "cli/exit_codes.h"
#include "cli/progress.h"
#include "restore/app/comparison_text.h"
#include "restore/app/frame_source.h"
#include "sim/dataset/files.h"
#include "sim/dataset/image_io.h"

namespace shimmer::restore::app {
namespace {

// All paths are looked at before anything is measured.
Comparison Measured(const CompareOptions& options, const std::atomic<bool>& stop) {
  const auto a = OpenFrames(options.a, stop), b = OpenFrames(options.b, stop);
  const auto mask = options.mask.empty() ? nullptr : OpenFrames(options.mask, stop);
  ComparisonTask task{.a = {options.a.string(), *a},
                      .b = {options.b.string(), *b},
                      .are_masks = options.are_masks,
                      .mask = {},
                      .slices = !options.slices.empty(),
                      .slice_row = options.row,
                      .threads = options.threads};
  if (mask) task.mask.emplace(options.mask.string(), *mask);
  cli::Progress progress("frames", a->count(), 0, options.quiet);
  return CompareSequences(task, stop, [&] { progress.Step(); });
}

}  // namespace

int Compare(const CompareOptions& options, const std::atomic<bool>& stop) {
  Comparison comparison;
  try {
    comparison = Measured(options, stop);
  } catch (const dataset::Interrupted&) {
    return cli::kExitInterrupted;
  }
  const std::string a = options.a.string(), b = options.b.string();
  if (!options.json.empty()) {
    const std::string text = ComparisonJson(comparison, a, b)
                                 .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                             "\n";
    dataset::WriteFileAtomically(options.json, dataset::AsBytes(text));
  }
  if (!options.slices.empty()) {
    dataset::MakeFolders(options.slices);
    const char* const names[] = {"a.png", "b.png"};
    for (size_t i = 0; i < 2; ++i)
      dataset::WriteFileAtomically(options.slices / names[i],
                                   dataset::EncodePng(dataset::FromSamples(comparison.slices[i]), 8));
  }
  cli::Print(ComparisonTable(comparison, a, b));
  return cli::kExitDone;
}

}  // namespace shimmer::restore::app
