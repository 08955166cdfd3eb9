// Whole data sets by the program itself: clips a second once its sources are decoded, memory, and what truth,
// layouts and the general PNG writer cost; beside it the authors' method with OpenCV's PNG writer, on the
// same photographs.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/bench/authors_method.h"
#include "tests/bench/program_run.h"
#include "tests/bench/table.h"

namespace shimmer::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Options {
  std::vector<std::string> pictures = {"/usr/share/backgrounds/Picture_1A_by_freespace.jpg",
                                       "/usr/share/backgrounds/life_by_Aitzol_Berasategi.jpg",
                                       "/usr/share/wallpapers/BytheWater/contents/images/2560x1600.jpg",
                                       "/usr/share/wallpapers/ColorfulCups/contents/images/2560x1600.jpg",
                                       "/usr/share/wallpapers/Path/contents/images/2560x1600.jpg"};
  fs::path out = fs::temp_directory_path();
  std::string only, json;
  int rounds = 3;
  bool quick = false;
};

struct Case {
  const char* name;
  int side_px;
  int clips, warm_up;           // the clock starts once so many are done: every source is decoded by then
  Json output;                  // section output of the config
  Json scene = Json::object();  // further sections
};

const Json kShake = {{"shake", "drift"}, {"amplitude_px", 4}, {"bound_px", 16}};
const Json kObjects = {{{"drawn", "box"},
                        {"height_px", 48},
                        {"shutter", 0.5},
                        {"motion", {{"start_x", 0.3}, {"start_y", 0.7}, {"speed_px", 3}}}},
                       {{"drawn", "walker"},
                        {"height_px", 80},
                        {"distance", 0.8},
                        {"motion", {{"start_x", 0.7}, {"start_y", 0.6}, {"direction_deg", 180}}}}};
const Json kSensor = {{"veil", 0.1}, {"full_well", 5000}, {"read_noise", 5}};
const Json kMoving = {{"camera", kShake}, {"objects", kObjects}};

const std::vector<Case> kCases = {
    {"256x256", 256, 1200, 200, Json::object()},
    {"256x256, truth", 256, 300, 100, {{"truth", {"tilt", "sigma"}}}},
    {"256x256, webdataset", 256, 1200, 200, {{"layout", "webdataset"}}},
    {"256x256, png_writer openimageio", 256, 400, 100, {{"png_writer", "openimageio"}}},
    {"256x256, shake", 256, 400, 100, Json::object(), {{"camera", kShake}}},
    {"256x256, two objects", 256, 400, 100, Json::object(), {{"objects", kObjects}}},
    {"256x256, sensor", 256, 400, 100, Json::object(), {{"sensor", kSensor}}},
    {"256x256, shake, two objects, their truth",
     256,
     300,
     100,
     {{"truth", {"mask", "flow", "shake"}}},
     kMoving},
    {"1024x1024", 1024, 100, 40, Json::object()},
    {"1024x1024, truth", 1024, 60, 30, {{"truth", {"tilt", "sigma"}}}},
    {"1024x1024, shake, two objects, their truth",
     1024,
     60,
     30,
     {{"truth", {"mask", "flow", "shake"}}},
     kMoving},
};

constexpr int kFrames = 16, kQuickFrames = 2;

// The training config of docs/formats.md.
Json ConfigOf(const Case& one, const Options& options) {
  Json config = {{"seed", 7},
                 {"clips", options.quick ? 4 : one.clips},
                 {"frames", options.quick ? kQuickFrames : kFrames},
                 {"size", options.quick ? Json{48, 48} : Json{one.side_px, one.side_px}},
                 {"source",
                  {{"images", options.pictures},
                   {"scale", {{"uniform", {0.5, 1}}}},
                   {"crop", "random"},
                   {"flip", true}}},
                 {"tilt",
                  {{"strength_px", {{"uniform", {1, 10}}}},
                   {"base_frequency", {{"uniform", {0.015, 0.06}}}},
                   {"temporal_scale", {{"uniform", {0.5, 4}}}}}},
                 {"blur", {{"max_sigma_px", {{"uniform", {0.5, 6}}}}}},
                 {"output", one.output}};
  config.update(one.scene);
  return config;
}

// A folder that is gone afterwards, and not before: a file system may search long for inodes of new files
// among those that were removed a minute ago.
class Scratch {
 public:
  explicit Scratch(const fs::path& parent) : path_(parent / ("bench_generate_" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

struct Measured {
  double clips_per_s = 0, cpu_s_per_clip = 0, MB_per_clip = 0, peak_MB = 0;
};

Measured RunCase(const Case& one, const fs::path& folder, const Options& options) {
  fs::create_directories(folder);
  const fs::path config = folder / "config.json", set = folder / "set";
  std::ofstream(config) << ConfigOf(one, options);
  const int warm_up = options.quick ? 1 : one.warm_up, clips = options.quick ? 4 : one.clips;
  LineCounter counter(set / "manifest.jsonl");
  int64_t lines = 0, first_lines = 0;
  double first_s = 0, last_s = 0;
  const ProgramRun run =
      RunProgram({SHIMMER_PROGRAM, "generate", config, "--out", set, "--quiet"}, [&](double seconds) {
        const int64_t now = counter.Now();
        if (now == lines) return;
        lines = now, last_s = seconds;
        if (now >= warm_up && first_lines == 0) first_lines = now, first_s = seconds;
      });
  if (counter.Now() != clips) throw std::runtime_error(std::string(one.name) + ": not every clip was made");
  uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(set))
    if (entry.is_regular_file()) bytes += entry.file_size();
  const double rate = last_s > first_s && lines > first_lines
                          ? static_cast<double>(lines - first_lines) / (last_s - first_s)
                          : clips / run.wall_s;
  return {rate, run.cpu_s / clips, static_cast<double>(bytes) / 1e6 / clips, run.peak_MB};
}

double Median(const std::vector<Measured>& rounds, double Measured::*figure) {
  std::vector<double> values;
  for (const Measured& round : rounds) values.push_back(round.*figure);
  std::ranges::sort(values);
  return values[values.size() / 2];
}

// A clip of each picture on one core, the pictures decoded before the clock starts.
Json RunAuthors(int side_px, const Options& options) {
  std::vector<cv::Mat> pictures;
  for (const std::string& name : options.pictures)
    if (cv::Mat picture = cv::imread(name); !picture.empty()) pictures.push_back(picture);
  if (pictures.empty()) throw std::runtime_error(options.pictures[0] + " is not a picture that can be read");
  const int frames = options.quick ? kQuickFrames : kFrames, side = options.quick ? 48 : side_px;
  for (cv::Mat& picture : pictures) cv::resize(picture, picture, {side, side}, 0, 0, cv::INTER_AREA);
  sim::Scene scene;
  scene.tilt.strength_px = 5, scene.blur.max_sigma_px = 3.25;
  std::vector<uchar> file;
  size_t bytes = 0;
  const auto keep = [&](const cv::Mat& frame) {
    cv::imencode(".png", frame, file);
    bytes += file.size();
  };
  const auto start = std::chrono::steady_clock::now();
  for (const cv::Mat& clean : pictures) {
    const AuthorsMethod method(scene, clean.size(), frames, AuthorsMode::kFast);
    for (const cv::Mat& frame : method.RenderClip(clean)) keep(frame);
    keep(clean);
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  const double clips = static_cast<double>(pictures.size()), seconds = taken.count() / clips;
  return {{"name", "the authors' method, one core, " + SizeText({side, side})},
          {"clips_per_s", 1 / seconds},
          {"cpu_s_per_clip", seconds},
          {"MB_per_clip", static_cast<double>(bytes) / 1e6 / clips}};
}

void Run(const Options& options) {
  const Scratch scratch(options.out);
  std::vector<std::vector<Measured>> measured(kCases.size());
  for (int round = 0; round < options.rounds; ++round)
    for (size_t i = 0; i < kCases.size(); ++i)
      if (options.only.empty() || options.only == kCases[i].name)
        measured[i].push_back(
            RunCase(kCases[i], scratch.path() / (std::to_string(round) + "_" + std::to_string(i)), options));
  Json rows = Json::array();
  for (size_t i = 0; i < kCases.size(); ++i)
    if (const std::vector<Measured>& rounds = measured[i]; !rounds.empty())
      rows.push_back({{"name", kCases[i].name},
                      {"clips_per_s", Median(rounds, &Measured::clips_per_s)},
                      {"cpu_s_per_clip", Median(rounds, &Measured::cpu_s_per_clip)},
                      {"MB_per_clip", Median(rounds, &Measured::MB_per_clip)},
                      {"peak_MB", Median(rounds, &Measured::peak_MB)}});
  if (options.only.empty())
    for (const int side_px : {256, 1024}) rows.push_back(RunAuthors(side_px, options));
  Table table({"16-frame clips", "clips/s", "CPU s/clip", "MB/clip", "peak MB"});
  for (const Json& row : rows)
    table.Add({row.at("name"), Significant(row.at("clips_per_s"), 3),
               Significant(row.at("cpu_s_per_clip"), 3), Significant(row.at("MB_per_clip"), 3),
               row.contains("peak_MB") ? Number(row.at("peak_MB"), 0) : "-"});
  table.Print();
  if (!options.json.empty() && !(std::ofstream(options.json) << rows.dump(2) << std::endl))
    throw std::runtime_error(options.json + " can't be written");
}

}  // namespace
}  // namespace shimmer::bench

int main(int argc, char** argv) {
  using namespace shimmer::bench;
  CLI::App app("Whole data sets by the program: clips a second, memory, size");
  Options options;
  std::vector<std::string> names;
  for (const Case& one : kCases) names.push_back(one.name);
  app.add_option("--pictures", options.pictures, "photographs (default: five of scripts/setup.sh --photos)");
  app.add_option("--out", options.out,
                 "folder to write in, 8 GB a round, emptied afterwards (default: the temporary one)");
  app.add_option("--only", options.only, "one case")->check(CLI::IsMember(names));
  app.add_option("--rounds", options.rounds, "medians of so many (default: 3)")->check(CLI::PositiveNumber);
  app.add_option("--json", options.json, "write all figures to this file");
  app.add_flag("--quick", options.quick, "tiny clips: does it work at all?");
  CLI11_PARSE(app, argc, argv);
  try {
    cv::setNumThreads(1);
    Run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_generate: %s\n", error.what());
    return 1;
  }
}
