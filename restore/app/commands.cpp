#include "restore/app/commands.h"

#include "cli/command_line.h"
#include "cli/exit_codes.h"
#include "restore/app/compare.h"

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

  try {
    if (argc > 1 && argv[1][0] != '-') cli::RequireCommand(app, argv[1]);
    app.parse(argc, argv);
    return Compare(compare, listen());
  } catch (...) {
    return cli::ReportCaught(app);
  }
}

}  // namespace shimmer::restore::app
