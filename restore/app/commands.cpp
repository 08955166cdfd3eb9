#include "restore/app/commands.h"

#include "cli/command_line.h"
#include "cli/exit_codes.h"
#include "restore/app/compare.h"
#include "restore/app/evaluation/evaluate_options.h"
#include "restore/app/restore.h"
#include "restore/app/settings_options.h"

namespace shimmer::restore::app {

int RunUnshimmer(int argc, const char* const* argv, const std::atomic<bool>& (*listen)()) {
  CLI::App app("Restores turbulent video, and says how well.", "unshimmer");
  app.set_version_flag("--version", "unshimmer 0.1.0");
  app.require_subcommand(1);

  const std::string source = "a picture, a folder of frames, a name with one %d or %06d, or a video";
  CompareOptions compare;
  CLI::App* compare_command =
      app.add_subcommand("compare", "measure how near A is to B, and how straight and steady each is");
  compare_command->add_option("A", compare.a, source)->required();
  compare_command->add_option("B", compare.b, "what A should be: as many frames of the same size, or one")
      ->required();
  CLI::Option* iou = compare_command->add_flag(
      "--iou", compare.are_masks,
      "A and B are masks, what moves is white: print IoU, precision and recall of A against the true B");
  compare_command
      ->add_option("--mask", compare.mask,
                   "what moves is white here: frames as those of A, or one. Left out of stability")
      ->excludes(iou);
  compare_command->add_option("--json", compare.json, "write all values of each frame to this file");
  compare_command->add_option("--slices", compare.slices,
                              "write a row of each over time to this folder: a.png and b.png");
  compare_command->add_option("--row", compare.row, "which row, px from the top (default: the middle)")
      ->check(CLI::NonNegativeNumber)
      ->needs("--slices");
  compare_command->add_option("--threads", compare.threads, "number of threads (default: all)")
      ->check(CLI::Range(1, 4096));
  compare_command->add_flag("--quiet", compare.quiet, "no progress");

  RestoreOptions restore;
  const auto add_restore_options = [&](CLI::App& command) {
    command.add_option("VIDEO", restore.video, source + ", or the folder of a clip that shimmer made")
        ->required();
    AddSettingsOptions(command, restore.settings);
    AddOpticsOptions(command, restore.optics);
    command.add_option("--threads", restore.threads, "number of threads (default: all)")
        ->check(CLI::Range(1, 4096));
    command.add_flag("--quiet", restore.quiet, "no progress");
  };
  CLI::App* restore_command = app.add_subcommand("restore", "make a turbulent video steady and clear");
  add_restore_options(*restore_command);
  restore_command
      ->add_option("--out", restore.out,
                   "a new folder for the frames, or a name that ends in .mp4, .mkv, .mov or .avi")
      ->required();
  restore_command->add_option("--stages", restore.stages, "write what each stage makes to this new folder");
  restore_command
      ->add_option("--fps", restore.frames_per_s, "of a video that is written (default: as VIDEO, else 25)")
      ->check(CLI::Range(0.1, 1000.0));
  CLI::App* plan_command =
      app.add_subcommand("plan", "print what VIDEO is like, and what restore would skip");
  add_restore_options(*plan_command);

  EvaluateOptions evaluate;
  CLI::App* evaluate_command =
      app.add_subcommand("evaluate", "restore clips whose truth is known, and hold every stage against it");
  AddEvaluateOptions(*evaluate_command, evaluate);

  try {
    if (argc > 1 && argv[1][0] != '-') cli::RequireCommand(app, argv[1]);
    app.parse(argc, argv);
    if (restore_command->parsed()) return RestoreVideo(restore, listen());
    if (plan_command->parsed()) return PrintPlan(restore, listen());
    if (evaluate_command->parsed()) return Evaluate(evaluate, listen());
    return Compare(compare, listen());
  } catch (...) {
    return cli::ReportCaught(app);
  }
}

}  // namespace shimmer::restore::app
