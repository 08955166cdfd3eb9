#include <opencv2/imgproc.hpp>

#include "tests/bench/step_sections.h"

namespace shimmer::bench {
namespace {

struct Skip {
  std::string name;
  sim::Scene scene = StandardScene(false);
  std::function<cv::Mat(cv::Mat)> change = [](cv::Mat clean) { return clean; };
  int divisor = 1;  // of the frame's sides
};

std::vector<Skip> Skips() {
  const auto grey = [](cv::Mat clean) {
    cv::cvtColor(clean, clean, cv::COLOR_RGB2GRAY);
    return clean;
  };
  std::vector<Skip> skips{{.name = "nothing skipped"}};
  skips.push_back({.name = "still, prepared once", .scene = StandardScene(true)});
  skips.push_back({.name = "no tilt"});
  skips.back().scene.tilt.strength_px = 0;
  skips.push_back({.name = "tilt of 0.05 px: octaves below the budget"});
  skips.back().scene.tilt.strength_px = 0.05;
  skips.push_back({.name = "no blur"});
  skips.back().scene.blur.max_sigma_px = 0;
  skips.push_back({.name = "sigma up to 0.05 px: nothing to see"});
  skips.back().scene.blur.max_sigma_px = 0.05;
  skips.push_back({.name = "one sigma everywhere"});
  skips.back().scene.blur.min_sigma_px = skips.back().scene.blur.max_sigma_px;
  skips.push_back({.name = "frozen"});
  skips.back().scene.tilt.temporal_scale = skips.back().scene.blur.temporal_scale = 0;
  skips.push_back({.name = "grey stored as RGB", .change = [=](cv::Mat clean) {
                     cv::cvtColor(grey(clean), clean, cv::COLOR_GRAY2RGB);
                     return clean;
                   }});
  skips.push_back({.name = "one channel", .change = grey});
  skips.push_back({.name = "constant picture", .change = [](cv::Mat clean) {
                     return cv::Mat(clean.size(), clean.type(), cv::Scalar(90, 120, 150));
                   }});
  skips.push_back({.name = "crop of a quarter by a quarter", .divisor = 4});
  return skips;
}

}  // namespace

Json SkipsSection(const StepOptions& options) {
  const cv::Size whole = options.FullHd();
  std::printf("Skipping: %s, video, one thread; one thing changed at a time\n", SizeText(whole).c_str());
  Table table({"", "CPU ms", "of the whole", "setup ms"});
  Json json = Json::array();
  double whole_ms = 0;
  const CleanPicture picture(options.picture, whole);
  for (const Skip& skip : Skips()) {
    const cv::Size size = whole / skip.divisor;
    const StepResult result = RunStep({skip.scene, size, 1}, options.patience(), [&](int halo_px) {
      const cv::Mat clean = picture.Bytes(halo_px);
      const cv::Rect crop(0, 0, size.width + 2 * halo_px, size.height + 2 * halo_px);
      return skip.change(clean(crop).clone());
    });
    if (whole_ms == 0) whole_ms = result.time.cpu_ms;
    table.Add({skip.name, Number(result.time.cpu_ms, 2),
               Number(100 * result.time.cpu_ms / whole_ms, 1) + " %", Number(result.setup_ms, 1)});
    Json record = Record(result);
    record["name"] = skip.name;
    record["share"] = result.time.cpu_ms / whole_ms;
    json.push_back(record);
  }
  table.Print();
  return json;
}

}  // namespace shimmer::bench
