#include "restore/app/evaluation/evaluate_options.h"

#include "restore/app/settings_options.h"
#include "sim/dataset/shard_option.h"

namespace shimmer::restore::app {

void AddEvaluateOptions(CLI::App& command, EvaluateOptions& options) {
  command.add_option("DATASET", options.set,
                     "clips that shimmer generated; with --adapter the folder of a set of others");
  command.add_option("--out", options.out, "the report's folder; again, it goes on where it stopped")
      ->required();
  command.add_option("--adapter", options.adapter,
                     "a JSON file that says where a set of others has its frames and their truth");
  command.add_option("--real", options.real,
                     "videos of which nothing is known: how straight and steady they become");
  command.add_flag("--ablations", options.variants.ablations,
                   "also without each stage, with the paper's averaged flow, and with another optical flow");
  command.add_flag("--baselines", options.variants.baselines,
                   "also the mean and the median over time, lucky-region fusion and unsharp masking");
  command
      .add_option(
          "--variant", options.variants.changed,
          "another way to restore: NAME:SETTING=VALUE,..., with stabilise, segment, flow, register, stack, "
          "sharpen or model; as often as wanted")
      ->take_all()
      ->expected(1);
  command
      .add_option(
          "--method", options.variants.methods,
          "results of another method: NAME=FOLDER, which has a folder of frames or a video a clip; as "
          "often as wanted")
      ->take_all()
      ->expected(1);
  AddSettingsOptions(command, options.variants.settings);
  command.add_option("--clips", options.clips, "the first so many alone")->check(CLI::PositiveNumber);
  command.add_option_function<std::string>(
      "--shard", [&](const std::string& text) { options.shard = dataset::ShardOf(text); },
      "i/N: every N-th clip from the i-th on; or slurm, by the task's number in its job array");
  command
      .add_option("--jobs", options.jobs,
                  "clips at a time (default: 1; times are then those of a machine that does nothing else)")
      ->check(CLI::Range(1, 1024));
  command.add_option("--threads", options.threads, "number of threads, of all jobs (default: all)")
      ->check(CLI::Range(1, 4096));
  command.add_flag("--quiet", options.quiet, "no progress");
}

}  // namespace shimmer::restore::app
