#include <limits>

#include "tests/bench/step_sections.h"

namespace shimmer::bench {
namespace {

constexpr double kMega = 1 << 20;

}  // namespace

Json Record(const StepResult& result) {
  return {{"ms", result.time.wall_ms},    {"best_ms", result.time.best_wall_ms},
          {"cpu_ms", result.time.cpu_ms}, {"runs", result.time.runs},
          {"setup_ms", result.setup_ms},  {"peak_bytes", result.peak_bytes}};
}

Json StepSection(const StepOptions& options) {
  const cv::Size size = options.FullHd();
  const CleanPicture picture(options.picture, size);
  std::printf("The step: %s RGB 8 bit, f = 1/64, S = 5 px, sigma 0 to 8 px\n", SizeText(size).c_str());
  Table table({"source", "threads", "ms", "quickest", "CPU ms", "frames/s", "scaling", "setup ms", "peak MiB",
               "MiB a thread"});
  Json json = Json::array();
  for (const bool still : {true, false}) {
    StepResult alone;
    for (const int threads : {1, 2}) {
      const StepResult result = Run({StandardScene(still), size, threads}, options, picture);
      if (threads == 1) alone = result;
      const double scaling = alone.time.best_wall_ms / result.time.best_wall_ms;
      const auto thread_bytes = static_cast<double>(result.peak_bytes - alone.peak_bytes);
      table.Add({still ? "still" : "video", std::to_string(threads), Number(result.time.wall_ms, 1),
                 Number(result.time.best_wall_ms, 1), Number(result.time.cpu_ms, 1),
                 Number(1000 / result.time.wall_ms, 1), Number(scaling, 2), Number(result.setup_ms, 1),
                 Number(static_cast<double>(result.peak_bytes) / kMega, 1),
                 threads == 1 ? "" : Number(thread_bytes / (threads - 1) / kMega, 1)});
      Json record = Record(result);
      record["source"] = still ? "still" : "video";
      record["threads"] = threads;
      record["scaling"] = scaling;
      record["frames_per_s"] = 1000 / result.time.wall_ms;
      json.push_back(record);
    }
  }
  table.Print();
  return json;
}

Json ExamplesSection(const StepOptions& options) {
  const cv::Size size = options.FullHd();
  const CleanPicture picture(options.picture, size);
  const int clips = options.quick ? 2 : 30;
  std::printf(
      "Training clips: %s, S 1 to 10 px, f 0.015 to 0.06, v 0.5 to 4, sigma up to 0.5 to 6 px; %d clips\n",
      SizeText(size).c_str(), clips);
  Table table({"threads", "mean ms", "worst ms", "mean CPU ms", "mean setup ms", "worst clip"});
  Json json = Json::array();
  for (const int threads : {1, 2}) {
    double sum_ms = 0, sum_cpu_ms = 0, sum_setup_ms = 0, worst_ms = 0;
    std::string worst;
    Json records = Json::array();
    for (int clip = 0; clip < clips; ++clip) {
      const sim::Scene scene = ExampleScene(static_cast<uint64_t>(clip));
      const Patience patience = options.quick ? options.patience() : Patience{0.4, 2, 9};
      const StepResult result =
          RunStep({scene, size, threads}, patience, [&](int halo_px) { return picture.Bytes(halo_px); });
      sum_ms += result.time.wall_ms;
      sum_cpu_ms += result.time.cpu_ms;
      sum_setup_ms += result.setup_ms;
      if (result.time.wall_ms > worst_ms) {
        worst_ms = result.time.wall_ms;
        worst = "S " + Number(scene.tilt.strength_px, 1) + ", f " + Number(scene.tilt.base_frequency, 3) +
                ", sigma " + Number(scene.blur.max_sigma_px, 1);
      }
      Json record = Record(result);
      record["strength_px"] = scene.tilt.strength_px;
      record["base_frequency"] = scene.tilt.base_frequency;
      record["max_sigma_px"] = scene.blur.max_sigma_px;
      records.push_back(record);
    }
    table.Add({std::to_string(threads), Number(sum_ms / clips, 1), Number(worst_ms, 1),
               Number(sum_cpu_ms / clips, 1), Number(sum_setup_ms / clips, 1), worst});
    json.push_back({{"threads", threads},
                    {"mean_ms", sum_ms / clips},
                    {"mean_cpu_ms", sum_cpu_ms / clips},
                    {"worst_ms", worst_ms},
                    {"clips", records}});
  }
  table.Print();
  return json;
}

Json SizesSection(const StepOptions& options) {
  const std::vector<cv::Size> sizes = options.quick
                                          ? std::vector<cv::Size>{{64, 64}, {96, 96}, {160, 90}}
                                          : std::vector<cv::Size>{{256, 256},   {512, 512},   {1024, 1024},
                                                                  {1920, 1080}, {3840, 2160}, {7680, 4320}};
  std::printf("Sizes: still, f = 1/64, S = 5 px, sigma 0 to 8 px, one thread\n");
  Table table({"size", "CPU ms", "ns a pixel", "peak MiB", "bytes a pixel"});
  Json records = Json::array();
  double least_ns = std::numeric_limits<double>::infinity(), most_ns = 0;
  for (const cv::Size size : sizes) {
    const CleanPicture picture(options.picture, size);
    const StepResult result = Run({StandardScene(true), size, 1}, options, picture);
    const double ns = 1e6 * result.time.cpu_ms / size.area();
    least_ns = std::min(least_ns, ns);
    most_ns = std::max(most_ns, ns);
    const auto peak_bytes = static_cast<double>(result.peak_bytes);
    table.Add({SizeText(size), Number(result.time.cpu_ms, 2), Number(ns, 1), Number(peak_bytes / kMega, 1),
               Number(peak_bytes / size.area(), 1)});
    Json record = Record(result);
    record["width"] = size.width;
    record["height"] = size.height;
    record["ns_per_pixel"] = ns;
    records.push_back(record);
  }
  table.Print();
  std::printf("Largest over smallest time a pixel: %.2f\n\n", most_ns / least_ns);
  return {{"sizes", records}, {"largest_ratio", most_ns / least_ns}};
}

}  // namespace shimmer::bench
