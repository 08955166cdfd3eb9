#include "sim/app/commands.h"

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/error_line.h"
#include "cli/exit_codes.h"
#include "sim/app/generate.h"
#include "sim/app/job.h"
#include "sim/app/merge.h"
#include "sim/app/plan_text.h"
#include "sim/app/preview.h"
#include "sim/app/report.h"
#include "sim/app/verify.h"
#include "sim/dataset/shard_option.h"

namespace shimmer::app {
namespace {

std::string PlanText(const std::filesystem::path& config_path, const std::vector<std::string>& sets,
                     int64_t clip) {
  const ConfigFile file = LoadConfig(config_path, sets);
  if (clip >= file.fixed().clips)
    throw std::invalid_argument("--clip " + std::to_string(clip) + ": must be in [0, " +
                                std::to_string(file.fixed().clips - 1) + "]");
  Json drawn = Json::object();
  const Config config = file.Draw(static_cast<uint64_t>(clip), &drawn);
  const bool still = config.source.video.empty() && config.source.sequence.empty();
  const sim::ClipPlan plan = PlanOf(config, still);
  return Json{{"clip", clip},
              {"drawn", drawn},
              {"plan", PlanJson(plan)},
              {"skipped", SkippedLines(config, plan)}}
             .dump(2) +
         "\n";
}

}  // namespace

int RunShimmer(int argc, const char* const* argv, const std::atomic<bool>& (*listen)()) {
  CLI::App app("Paired clips seen through atmospheric turbulence, from clean pictures and one config file.",
               "shimmer");
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);

  GenerateOptions generate;
  const auto add_config = [](CLI::App* command, std::filesystem::path& config,
                             std::vector<std::string>& sets) {
    command->add_option("CONFIG", config, "config file (JSON; `shimmer keys` lists what it may say)")
        ->required();
    command->add_option("--set", sets, "override a key: tilt.strength_px=5. Repeat as needed")
        ->allow_extra_args(false);
  };
  CLI::App* generate_command = app.add_subcommand(
      "generate", "make the clips of a config; the same command again goes on where it stopped");
  add_config(generate_command, generate.config, generate.sets);
  generate_command->add_option("--out", generate.out, "folder of the data set")->required();
  generate_command->add_option("--clip", generate.only_clips, "make only this clip. Repeat as needed")
      ->allow_extra_args(false);
  generate_command->add_option("--threads", generate.threads, "number of threads (default: all)")
      ->check(CLI::Range(1, 4096));
  generate_command
      ->add_option("--memory", generate.memory_bytes,
                   "what to keep within, sources included: 512M, 4G (default: 1G)")
      ->transform(CLI::AsSizeValue(false))
      ->check(CLI::Range(int64_t{1}, int64_t{1} << 50).description(""));
  generate_command->add_option_function<std::string>(
      "--shard", [&](const std::string& text) { generate.shard = dataset::ShardOf(text); },
      "make a part: i/N, i from 0, or slurm (this task of a job array)");
  generate_command->add_flag("--retry-failed", generate.retry_failed, "also clips that failed before");
  generate_command->add_flag("--dry-run", generate.dry_run,
                             "only say what it takes: clips, files, bytes, time and free space");
  generate_command->add_flag("--wait", generate.wait, "wait while another process writes to the folder");
  generate_command->add_flag("--quiet", generate.quiet, "no progress");

  MergeOptions merge;
  CLI::App* merge_command =
      app.add_subcommand("merge", "make one data set of shards, and say what is missing");
  merge_command->add_option("DIR", merge.folder, "folder of the data set")->required();
  merge_command->add_option("FROM", merge.from, "folders of shards (default: they wrote to DIR)");

  VerifyOptions verify;
  CLI::App* verify_command = app.add_subcommand(
      "verify", "recount, hash and decode a data set: is every clip whole, and nothing else there?");
  verify_command->add_option("DIR", verify.folder, "folder of the data set")->required();
  verify_command->add_flag("--repair", verify.repair,
                           "make again what is missing or wrong; move what is too much to DIR/.surplus");
  verify_command->add_option("--config-folder", verify.config_folder,
                             "where relative sources are looked up (default: where the config file lay)");
  verify_command->add_option("--threads", verify.threads, "number of threads (default: all)")
      ->check(CLI::Range(1, 4096));
  verify_command->add_flag("--quiet", verify.quiet, "only the summary");

  std::filesystem::path plan_config;
  std::vector<std::string> plan_sets;
  int64_t plan_clip = 0;
  CLI::App* plan_command =
      app.add_subcommand("plan", "print what a clip of a config needs, and what is skipped");
  add_config(plan_command, plan_config, plan_sets);
  plan_command->add_option("--clip", plan_clip, "which clip (default: 0)")->check(CLI::NonNegativeNumber);

  PreviewOptions preview;
  CLI::App* preview_command =
      app.add_subcommand("preview", "draw a data set: a contact sheet (.png) or one clip moving (.gif)");
  preview_command->add_option("DIR", preview.folder, "folder of the data set")->required();
  preview_command->add_option("--out", preview.out, "picture to write: .png or .gif")->required();
  preview_command->add_option("--clip", preview.clip, "the clip that the .gif shows (default: the first)")
      ->check(CLI::NonNegativeNumber);
  preview_command->add_option("--rows", preview.rows, "rows of the sheet (default: 8)")
      ->check(CLI::Range(1, 100));

  std::filesystem::path report_folder;
  CLI::App* report_command =
      app.add_subcommand("report", "write a page about a data set, DIR/report.html, and print its path");
  report_command->add_option("DIR", report_folder, "folder of the data set")->required();

  CLI::App* keys_command =
      app.add_subcommand("keys", "list every key of a config, with its range, default and meaning");
  CLI::App* schema_command = app.add_subcommand("schema", "print the config's JSON schema");

  const std::filesystem::path* config_path = nullptr;
  try {
    if (argc > 1 && argv[1][0] != '-') cli::RequireCommand(app, argv[1]);
    app.parse(argc, argv);
    if (*generate_command) return config_path = &generate.config, Generate(generate, listen());
    if (*merge_command) return Merge(merge);
    if (*verify_command) return Verify(verify, listen());
    if (*plan_command) config_path = &plan_config, cli::Print(PlanText(plan_config, plan_sets, plan_clip));
    if (*preview_command) Preview(preview);
    if (*report_command) cli::Print(WriteReport(report_folder).string() + "\n");
    if (*keys_command) cli::Print(KeysHelpText());
    if (*schema_command) cli::Print(SchemaText());
    return cli::kExitDone;
  } catch (const ConfigError& error) {
    const std::string where = error.pointer().empty() ? "" : ":" + error.pointer();
    cli::PrintError("shimmer", config_path->string() + where + ": " + error.what());
    return cli::kExitWrongInput;
  } catch (...) {
    return cli::ReportCaught(app);
  }
}

}  // namespace shimmer::app
