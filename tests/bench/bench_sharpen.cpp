// Restormers with random weights: milliseconds an image on all threads, multiply-adds a second, memory, and
// the largest error against the double twin, of a small image. The first two networks are of the paper's
// shape, the others for whole frames.
#include <fstream>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "restore/restormer.h"
#include "tests/bench/measure.h"
#include "tests/bench/sharpen_frames.h"
#include "tests/bench/table.h"
#include "tests/restore/random_network.h"
#include "tests/restore/restormer_twin.h"

namespace shimmer::bench {
namespace {

using Json = nlohmann::ordered_json;
using restore::Restormer;
using restore::RestormerShape;

struct Options {
  bool quick = false;
  std::string frames, model;
  std::string json_file;
};

struct Network {
  const char* name;
  RestormerShape shape;
  cv::Size size;
};

const std::vector<Network> kNetworks = {
    {"width 16", {.width = 16, .blocks = {1, 1, 2, 2}, .heads = {1, 2, 4, 8}, .refinement = 1}, {256, 256}},
    {"width 48, as in the paper", {}, {256, 256}},
    {"width 16, unshuffled by 2",
     {.width = 16,
      .blocks = {2, 2, 4},
      .heads = {1, 2, 4},
      .refinement = 1,
      .norm_with_bias = false,
      .unshuffle = 2},
     {1920, 1080}},
    {"width 32, unshuffled by 4",
     {.width = 32,
      .blocks = {2, 3, 4},
      .heads = {1, 2, 4},
      .refinement = 1,
      .norm_with_bias = false,
      .unshuffle = 4},
     {1920, 1080}},
};

double ErrorOf(const restore::SafeTensors& file, const Restormer& network, cv::Size size) {
  const cv::Mat image = restore::RandomImage(size, 2);
  cv::Mat out;
  network.Run(image).convertTo(out, CV_64F);
  return cv::norm(out, restore::RestormerTwin(file, image), cv::NORM_INF);
}

Json Run(const Options& options) {
  const Patience patience = options.quick ? Patience{0, 1, 1, 1} : Patience{8, 5, 25, 1};
  Table table(
      {"network", "parameters", "image", "ms", "quickest", "CPU ms", "GMAC", "GMAC/s", "peak MiB", "error"});
  Json json = Json::array();
  for (const auto& [name, shape, size] : kNetworks) {
    const cv::Size measured = options.quick ? size / 16 : size;
    const restore::SafeTensors file = restore::RandomNetwork(shape, 1);
    const Restormer network(file);
    const cv::Mat image = restore::RandomImage(measured, 3);
    const PeakMemory memory;
    const Timing timing = Measure(patience, [&](int) { network.Run(image); });
    const double gmac = restore::MultiplyAdds(shape, measured) / 1e9,
                 parameters = restore::ParameterCount(shape);
    const double peak_bytes = static_cast<double>(memory.Bytes());
    const double error = ErrorOf(file, network, options.quick ? cv::Size(9, 5) : cv::Size(33, 18));
    table.Add({name, Significant(parameters / 1e6, 3) + " M", SizeText(measured), Number(timing.wall_ms, 1),
               Number(timing.best_wall_ms, 1), Number(timing.cpu_ms, 1), Number(gmac, 2),
               Number(gmac / timing.wall_ms * 1e3, 1), Number(peak_bytes / (1 << 20), 0),
               Significant(error, 2)});
    json.push_back({{"network", name},
                    {"parameters", parameters},
                    {"image", SizeText(measured)},
                    {"ms", timing.wall_ms},
                    {"best_ms", timing.best_wall_ms},
                    {"cpu_ms", timing.cpu_ms},
                    {"multiply_adds", gmac * 1e9},
                    {"peak_bytes", peak_bytes},
                    {"error", error}});
  }
  table.Print();
  return json;
}

}  // namespace
}  // namespace shimmer::bench

int main(int argc, char** argv) {
  using namespace shimmer::bench;
  CLI::App app("Restormers: how fast, and how exact");
  Options options;
  app.add_flag("--quick", options.quick, "tiny images, one run each: does it work at all?");
  app.add_option("--json", options.json_file, "write all figures to this file")->type_name("FILE");
  CLI::Option* frames = app.add_option(
      "--frames", options.frames,
      "instead: frames of this folder, sharpened as unshimmer does it, with and without what is skipped");
  app.add_option("--model", options.model, "the network for them (default: the one that unshimmer carries)")
      ->needs(frames);
  CLI11_PARSE(app, argc, argv);
  try {
    std::ofstream file;
    if (!options.json_file.empty()) file.open(options.json_file);  // now, not after minutes of measuring
    if (!file) throw std::runtime_error(options.json_file + " can't be written");
    const Json json = options.frames.empty() ? Run(options) : SharpenFrames(options.frames, options.model);
    if (!options.json_file.empty() && !(file << json.dump(2) << std::endl))
      throw std::runtime_error(options.json_file + " can't be written");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_sharpen: %s\n", error.what());
    return 1;
  }
}
