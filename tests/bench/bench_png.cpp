// Milliseconds and bytes of a frame as PNG, ours beside OpenImageIO's, OpenCV's and libpng's writers at level
// 1, all in this run on one thread, on the same frames. Every file is decoded and compared with its frame.
#include <CLI/CLI.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/dataset/png_write.h"
#include "tests/bench/clean_picture.h"
#include "tests/bench/measure.h"
#include "tests/bench/png_writers.h"
#include "tests/bench/step_case.h"
#include "tests/bench/table.h"

namespace shimmer::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  bool quick = false;
  std::vector<std::string> pictures;
  std::string json_file;
};

// A kind of frame that is measured.
struct Kind {
  const char* name;
  cv::Size size;
  bool turbulent;
  int type;
};
constexpr int kSide = 1024;
const std::vector<Kind> kKinds = {{"clean, RGB, 8 bit", {kSide, kSide}, false, CV_8UC3},
                                  {"turbulent, RGB, 8 bit", {kSide, kSide}, true, CV_8UC3},
                                  {"turbulent, RGB, 16 bit", {kSide, kSide}, true, CV_16UC3},
                                  {"turbulent, grey, 8 bit", {kSide, kSide}, true, CV_8UC1},
                                  {"turbulent, RGB, 8 bit", {kSide / 4, kSide / 4}, true, CV_8UC3}};

cv::Mat InType(const cv::Mat& rgb, int type) {
  cv::Mat frame = rgb;
  if (CV_MAT_CN(type) == 1) cv::cvtColor(rgb, frame, cv::COLOR_RGB2GRAY);
  if (CV_MAT_DEPTH(type) == CV_16U) frame.convertTo(frame, CV_16U, 257);
  return frame;
}

// The frame of a kind from a picture; turbulent as the i-th clip of a training set.
cv::Mat FrameOf(const Kind& kind, const std::string& file, uint64_t i) {
  const CleanPicture picture(file, kind.size);
  if (!kind.turbulent) return InType(picture.Bytes(0), kind.type);
  Step step(ExampleScene(i), {.size = kind.size, .frames = 1}, {});
  const cv::Mat clean = InType(picture.Bytes(step.halo_px()), kind.type);
  step.Prepare(clean);
  cv::Mat turbulent;
  step.Render(0, turbulent);
  return turbulent;
}

void CheckDecodes(const std::vector<uint8_t>& file, const cv::Mat& frame, const std::string& writer) {
  cv::Mat back = cv::imdecode(file, cv::IMREAD_UNCHANGED);
  if (back.channels() == 3) cv::cvtColor(back, back, cv::COLOR_BGR2RGB);
  if (back.size() != frame.size() || back.type() != frame.type() || cv::norm(back, frame, cv::NORM_INF) != 0)
    throw std::runtime_error("the PNG of " + writer + " is not the frame that was written");
}

struct Cost {
  double ms = 0, share = 0;  // of a frame, and of the samples' bytes
};

Cost CostOf(const PngPeer& peer, const cv::Mat& frame, const Patience& patience) {
  cv::Mat samples = frame.clone();
  if (peer.blue_first && frame.channels() == 3) cv::cvtColor(frame, samples, cv::COLOR_RGB2BGR);
  std::vector<uint8_t> file;
  const double ms = Measure(patience, [&](int) { file = peer.write(samples); }).cpu_ms;
  CheckDecodes(file, frame, peer.name);
  return {ms, static_cast<double>(file.size()) / static_cast<double>(frame.total() * frame.elemSize())};
}

// The median time and the mean share over the pictures.
Cost SumUp(const std::vector<Cost>& costs) {
  std::vector<double> ms;
  double share = 0;
  for (const Cost& cost : costs) ms.push_back(cost.ms), share += cost.share;
  return {Median(ms), share / static_cast<double>(costs.size())};
}

Json Run(const Options& options) {
  const Patience patience = options.quick ? Patience{0, 1, 1, 1} : Patience{0.5, 3, 30, 4};
  const std::vector<std::string> pictures =
      options.pictures.empty() ? std::vector<std::string>{""} : options.pictures;
  std::printf(
      "A frame as PNG, one thread: ms (CPU, median over %zu pictures), and bytes over those of its samples\n",
      pictures.size());
  std::vector<std::string> head = {""};
  for (const PngPeer& peer : PngPeers()) head.push_back(peer.name);
  Table table(head);
  Json json = Json::array();
  for (Kind kind : kKinds) {
    if (options.quick) kind.size /= 16;
    std::vector<cv::Mat> frames;
    for (size_t i = 0; i < pictures.size(); ++i) frames.push_back(FrameOf(kind, pictures[i], i));
    std::vector<std::string> row = {std::string(kind.name) + ", " + SizeText(kind.size)};
    Json record{{"kind", kind.name}, {"width", kind.size.width}, {"height", kind.size.height}};
    for (const PngPeer& peer : PngPeers()) {
      std::vector<Cost> costs;
      for (const cv::Mat& frame : frames) costs.push_back(CostOf(peer, frame, patience));
      const Cost cost = SumUp(costs);
      row.push_back(Number(cost.ms, 2) + " ms, " + Number(cost.share, 3));
      record[peer.name] = {{"cpu_ms", cost.ms}, {"share", cost.share}};
    }
    table.Add(row);
    json.push_back(record);
  }
  table.Print();
  return json;
}

}  // namespace
}  // namespace shimmer::bench

int main(int argc, char** argv) {
  using namespace shimmer::bench;
  CLI::App app("A frame as PNG: ours beside others' writers");
  Options options;
  app.add_flag("--quick", options.quick, "tiny frames, one run each: does it work at all?");
  app.add_option("--picture", options.pictures, "these photographs, not a drawn scene")->type_name("FILE...");
  app.add_option("--json", options.json_file, "write all figures to this file")->type_name("FILE");
  CLI11_PARSE(app, argc, argv);
  try {
    cv::setNumThreads(1);
    std::ofstream file;
    if (!options.json_file.empty()) file.open(options.json_file);  // now, not after minutes of measuring
    if (!file) throw std::runtime_error(options.json_file + " can't be written");
    const auto json = Run(options);
    if (!options.json_file.empty() && !(file << json.dump(2) << std::endl))
      throw std::runtime_error(options.json_file + " can't be written");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_png: %s\n", error.what());
    return 1;
  }
}
