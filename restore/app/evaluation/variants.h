// What an evaluation compares: the pipeline, the pipeline with a stage left out or changed, what others would
// do first, and results of others on disk.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "restore/app/evaluation/results.h"
#include "restore/app/restoration.h"
#include "restore/baselines.h"

namespace shimmer::restore::app {

struct Variant {
  std::string name;  // letters, digits and ._- alone: files are named by it
  VariantKind kind = VariantKind::kPipeline;
  std::string changes = {};  // "stack=off": what an ablation has otherwise
  RestoreSettings settings;  // of the pipeline and ablations
  Baseline baseline = {};
  std::filesystem::path folder = {};  // of a method's results

  VariantText Text() const;
  // What tells it from others of its name: results of another are not taken for its.
  nlohmann::json Identity() const;
};

struct VariantOptions {
  RestoreSettings settings = {};              // of the full pipeline
  bool ablations = false, baselines = false;  // those that there always are
  std::vector<std::string> changed = {};      // "NAME:stack=off,segment=aof"
  std::vector<std::string> methods = {};      // "NAME=FOLDER"
};

// The input, then the full pipeline, ablations, baselines, methods, in this order. Throws
// std::invalid_argument for a name that is taken or can't be one, and as ChangeSetting.
std::vector<Variant> VariantsOf(const VariantOptions& options);

}  // namespace shimmer::restore::app
