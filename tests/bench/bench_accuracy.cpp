// Run time against error: the accuracy budget swept over three scenes, with the method of the paper's authors
// and OpenCV's way as points beside it, all timed in this run on one thread. Prints a table; writes OUT.json
// and OUT.png.
#include <CLI/CLI.hpp>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/bench/accuracy_points.h"
#include "tests/bench/plot.h"
#include "tests/bench/table.h"

namespace shimmer::bench {
namespace {

using Json = nlohmann::ordered_json;

const char* NameOf(Part part) {
  return std::array{"fields", "warp", "blur", "frame"}[static_cast<int>(part)];
}
const char* NameOf(Method method) {
  return std::array{"shimmer", "authors", "opencv"}[static_cast<int>(method)];
}
const char* NameOf(Sweep sweep) { return std::array{"px", "levels", "both"}[static_cast<int>(sweep)]; }

bool IsDefault(const AccuracyPoint& point) {
  const sim::Accuracy standard;
  return point.method == Method::kShimmer && point.budget.max_error_px == standard.max_error_px &&
         point.budget.max_error_levels == standard.max_error_levels;
}

// What the sweep set; of others than Shimmer nothing.
std::string BudgetText(const AccuracyPoint& point) {
  if (point.method != Method::kShimmer) return "";
  return Significant(point.sweep == Sweep::kPx ? point.budget.max_error_px : point.budget.max_error_levels,
                     3);
}

void PrintTable(const std::vector<AccuracyPoint>& points) {
  Table table({"part", "scene", "method", "max_error_px", "max_error_levels", "ns a pixel", "RMS error",
               "largest error", "unit"});
  for (const AccuracyPoint& point : points) {
    const bool ours = point.method == Method::kShimmer;
    table.Add({NameOf(point.part), point.scene, NameOf(point.method),
               ours ? Significant(point.budget.max_error_px, 3) : "",
               ours ? Significant(point.budget.max_error_levels, 3) : "", Number(point.ns_per_pixel, 2),
               Significant(point.error.rms, 3), Significant(point.error.max, 3),
               point.part == Part::kFields ? "px" : "1/255"});
  }
  table.Print();
}

Json AsJson(const std::vector<AccuracyPoint>& points, cv::Size size) {
  Json records = Json::array();
  for (const AccuracyPoint& point : points) {
    Json record{{"part", NameOf(point.part)}, {"scene", point.scene}, {"method", NameOf(point.method)}};
    if (point.method == Method::kShimmer) {
      record["sweep"] = NameOf(point.sweep);
      record["max_error_px"] = point.budget.max_error_px;
      record["max_error_levels"] = point.budget.max_error_levels;
    }
    record["ns_per_pixel"] = point.ns_per_pixel;
    record["error_unit"] = point.part == Part::kFields ? "px" : "1/255";
    record["rms_error"] = point.error.rms;
    record["max_error"] = point.error.max;
    records.push_back(record);
  }
  return {{"width", size.width}, {"height", size.height}, {"points", records}};
}

const std::map<std::string, cv::Scalar> kColours{
    {"weak", {178, 114, 0}}, {"medium", {0, 94, 213}}, {"strong", {115, 158, 0}}};  // blue, orange, green
const cv::Scalar kBlack(60, 60, 60);

Look LookOf(const AccuracyPoint& point, bool rms) {
  constexpr std::array kMarkers{Marker::kCircle, Marker::kSquare, Marker::kTriangle};
  return {.colour = kColours.at(point.scene),
          .marker = kMarkers[static_cast<size_t>(point.method)],
          .filled = rms,
          .line = true,
          .dashed = !rms};
}

// A panel of the points of one part, of Shimmer's those of one sweep.
Panel PanelOf(const std::vector<AccuracyPoint>& points, Part part, Sweep sweep, const std::string& title) {
  const bool px = part == Part::kFields;
  Panel panel{.title = title,
              .x_label = px ? "error of the shifts, px" : "error, 1/255 of the range",
              .y_label = "ns a pixel, one thread",
              .least_x = px ? 1e-7 : 1e-5,
              .series = {}};
  std::map<std::tuple<std::string, Method, bool>, Series> series;
  for (const AccuracyPoint& point : points) {
    if (point.part != part || (point.method == Method::kShimmer && point.sweep != sweep)) continue;
    for (const bool rms : {false, true}) {
      Series& one = series[{point.scene, point.method, rms}];
      one.look = LookOf(point, rms);
      const double error = rms ? point.error.rms : point.error.max;
      // Where a budget changes nothing, one name says enough.
      const bool new_place = one.points.empty() || one.points.back().x != error || IsDefault(point);
      one.points.push_back(
          {error, point.ns_per_pixel, rms && new_place ? BudgetText(point) : "", rms && IsDefault(point)});
    }
  }
  for (auto& [key, one] : series) panel.series.push_back(one);
  return panel;
}

cv::Mat Plot(const std::vector<AccuracyPoint>& points, cv::Size size) {
  const std::vector<Panel> panels{
      PanelOf(points, Part::kFields, Sweep::kPx, "Fields, max_error_px swept"),
      PanelOf(points, Part::kWarp, Sweep::kPx, "Warp, max_error_px swept"),
      PanelOf(points, Part::kBlur, Sweep::kLevels, "Blur, max_error_levels swept"),
      PanelOf(points, Part::kFrame, Sweep::kPx, "Whole frame, max_error_px swept"),
      PanelOf(points, Part::kFrame, Sweep::kLevels, "Whole frame, max_error_levels swept"),
      PanelOf(points, Part::kFrame, Sweep::kBoth,
              "Whole frame, both swept (max_error_px = half of max_error_levels)")};
  const auto look = [](const cv::Scalar& colour, Marker marker, bool filled, bool line) {
    return Look{
        .colour = colour, .marker = marker, .filled = filled, .line = line, .dashed = line && !filled};
  };
  const std::vector<LegendEntry> legend{
      {"weak: S = 2 px, sigma up to 1.5 px", look(kColours.at("weak"), Marker::kNone, true, true)},
      {"medium: S = 4 px, sigma up to 3 px", look(kColours.at("medium"), Marker::kNone, true, true)},
      {"strong: S = 8 px, sigma up to 6 px", look(kColours.at("strong"), Marker::kNone, true, true)},
      {"RMS error", look(kBlack, Marker::kCircle, true, true)},
      {"largest error", look(kBlack, Marker::kCircle, false, true)},
      {"default budget", look(kBlack, Marker::kCircle, true, false), true},
      {"Shimmer", look(kBlack, Marker::kCircle, true, false)},
      {"the paper authors' method", look(kBlack, Marker::kSquare, true, false)},
      {"OpenCV (its fields are given, at no cost)", look(kBlack, Marker::kTriangle, true, false)}};
  return DrawPlot("Run time against error: RGB, 8 bit, " + SizeText(size) + " px; the numbers are budgets",
                  panels, legend);
}

struct Options {
  bool quick = false;
  std::string picture, out = "accuracy";
};

void Run(const Options& options) {
  std::ofstream json(options.out + ".json");  // now, not after minutes of measuring
  if (!json) throw std::runtime_error(options.out + ".json can't be written");
  const AccuracySetup setup = options.quick
                                  ? AccuracySetup{{96, 64}, {0, 1, 1}, {0, 0.05, 0.3}, {0, 0.1, 1}}
                                  : AccuracySetup{{768, 512},
                                                  {0.4, 1, 25},
                                                  {0, 0.001, 0.003, 0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3},
                                                  {0, 0.01, 0.03, 0.05, 0.1, 0.2, 0.3, 1}};
  const CleanPicture picture(options.picture, setup.size);
  std::vector<AccuracyPoint> points;
  for (const AccuracyScene& scene : AccuracyScenes()) {
    const std::vector<AccuracyPoint> of_scene = MeasureAccuracy(scene, setup, picture);
    points.insert(points.end(), of_scene.begin(), of_scene.end());
  }
  std::ranges::stable_sort(points, {}, &AccuracyPoint::part);
  PrintTable(points);

  if (!(json << AsJson(points, setup.size).dump(2) << std::endl) ||
      !cv::imwrite(options.out + ".png", Plot(points, setup.size), {cv::IMWRITE_PNG_COMPRESSION, 9}))
    throw std::runtime_error(options.out + ".json and .png can't be written");
}

}  // namespace
}  // namespace shimmer::bench

int main(int argc, char** argv) {
  CLI::App app("Run time against error, over the accuracy budget");
  shimmer::bench::Options options;
  app.add_option("--out", options.out, "writes OUT.json and OUT.png")
      ->capture_default_str()
      ->type_name("OUT");
  app.add_option("--picture", options.picture, "degrade this photograph, not a drawn scene")
      ->type_name("FILE");
  app.add_flag("--quick", options.quick, "tiny frames, few budgets, one run each: does it work at all?");
  CLI11_PARSE(app, argc, argv);
  try {
    cv::setNumThreads(1);
    shimmer::bench::Run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_accuracy: %s\n", error.what());
    return 1;
  }
}
