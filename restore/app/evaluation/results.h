// What an evaluation found out, clip by clip.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "restore/app/evaluation/measures.h"

namespace shimmer::restore::app {

using OrderedJson = nlohmann::ordered_json;

// How frames came to be that are held against the truth.
enum class VariantKind { kInput, kPipeline, kAblation, kBaseline, kMethod };
const char* NameOf(VariantKind kind);  // "input", "pipeline", "ablation", "baseline", "method"

// The turbulent frames themselves; for a clip that shakes, moved by the true shake.
inline constexpr const char* kInputName = "input";
// The pipeline as it was asked for; others are named by what they leave out or have otherwise.
inline constexpr const char* kFullName = "full";

// What a row is of: a stage of the pipeline, as its output came through it, or what came out in the end. Only
// kFullName has rows of stages; every variant has one of kResultStage, with the time of all of it.
inline constexpr const char* kStageNames[] = {"look", "stabilise", "segment", "stack", "blend", "sharpen"};
inline constexpr const char* kResultStage = "result";

struct ResultRow {
  std::string variant, stage;
  Measures measures;
};

// What is known of a clip beside its frames; absent where the truth does not say it.
struct ClipFacts {
  std::string name;  // "000012"; of a real video its path
  int64_t frames = 0;
  cv::Size size;
  std::optional<double> tilt_rms_px;  // the true one, along an axis
  std::optional<bool> shakes;
  std::optional<int> objects;  // that move
};

struct VariantError {
  std::string variant, error;
};

struct ClipResult {
  ClipFacts facts;
  std::vector<ResultRow> rows;       // by variant, in order, then by stage
  std::vector<VariantError> errors;  // of variants that failed on this clip
};

struct VariantText {
  std::string name;
  VariantKind kind;
  std::string settings;  // for people: "segment=off"; of a method its folder; may be empty
};

struct Evaluation {
  std::string set;                    // the data set as it was given; empty: none
  std::vector<VariantText> variants;  // the input first, the full pipeline second
  std::vector<ClipResult> clips;      // whose truth is known
  std::vector<ClipResult> real;       // whose truth is not
  int64_t clips_of_set = 0;           // with those that are not evaluated yet
};

// The row, or null where there is none.
const ResultRow* FindRow(const ClipResult& clip, const std::string& variant,
                         const std::string& stage = kResultStage);

// A measure of a row, less the same of the input's; absent where one of them is.
Value GainOf(const ClipResult& clip, const std::string& variant, Measure measure,
             const std::string& stage = kResultStage);

// By tilt RMS: "weak" below 0.71 px, "medium" below 1.41, "strong"; empty where it is not known. These are
// halfway, as ratios, between the 0.5, 1 and 2 px that the words mean in this project.
std::string StrengthOf(const ClipFacts& facts);

}  // namespace shimmer::restore::app
