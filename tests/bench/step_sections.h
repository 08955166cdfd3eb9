// The parts of bench_step: each measures, prints its table, and gives its figures as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tests/bench/clean_picture.h"
#include "tests/bench/step_case.h"
#include "tests/bench/table.h"

namespace shimmer::bench {

using Json = nlohmann::ordered_json;

struct StepOptions {
  bool quick = false;   // tiny frames, one run each
  std::string picture;  // as of CleanPicture

  Patience patience() const { return quick ? Patience{0, 1, 1} : Patience{2, 3, 30}; }
  cv::Size FullHd() const { return quick ? cv::Size(160, 90) : cv::Size(1920, 1080); }
};

inline StepResult Run(const StepCase& step_case, const StepOptions& options, const CleanPicture& picture) {
  return RunStep(step_case, options.patience(), [&](int halo_px) { return picture.Bytes(halo_px); });
}

Json Record(const StepResult& result);

Json StepSection(const StepOptions& options);      // from a still and from a video, on one thread and two
Json ExamplesSection(const StepOptions& options);  // clips of a training set: what is drawn differs
Json SizesSection(const StepOptions& options);     // time a pixel: it should not depend on the size
Json PeersSection(const StepOptions& options);     // beside the authors' method and OpenCV's way, one core
Json SkipsSection(const StepOptions& options);     // what each thing that can be skipped saves

}  // namespace shimmer::bench
