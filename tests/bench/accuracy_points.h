// Run time and error of one part of the simulation, by one method, at one budget: the points of the plot that
// bench_accuracy draws.
#pragma once

#include <string>
#include <vector>

#include "sim/scene.h"
#include "tests/bench/clean_picture.h"
#include "tests/bench/double_pipeline.h"
#include "tests/bench/measure.h"

namespace shimmer::bench {

enum class Part { kFields, kWarp, kBlur, kFrame };
enum class Method { kShimmer, kAuthors, kOpenCv };
enum class Sweep { kPx, kLevels, kBoth };  // what of the budget varies; the other half keeps its default

struct AccuracyPoint {
  Part part;
  Method method;
  std::string scene;
  Sweep sweep = Sweep::kBoth;  // of Shimmer's points
  sim::Accuracy budget;        // of Shimmer's points
  double ns_per_pixel = 0;     // CPU time of one thread, 8 bit in and out
  Error error;                 // fields: px; else 1/255 of the range, on float frames, before quantising
};

struct AccuracyScene {
  std::string name;
  sim::Scene scene;
};
// Weak, medium and strong: tilt of 0.5, 1 and 2 px RMS an axis, sigma up to 1.5, 3 and 6 px.
std::vector<AccuracyScene> AccuracyScenes();

struct AccuracySetup {
  cv::Size size;
  Patience patience;
  std::vector<double> budgets_px, budgets_levels;
};

// All points of a scene: of each part, Shimmer over the budgets, and the others once.
std::vector<AccuracyPoint> MeasureAccuracy(const AccuracyScene& scene, const AccuracySetup& setup,
                                           const CleanPicture& picture);

}  // namespace shimmer::bench
