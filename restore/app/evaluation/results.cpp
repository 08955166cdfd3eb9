#include "restore/app/evaluation/results.h"

#include <algorithm>

namespace shimmer::restore::app {

const char* NameOf(VariantKind kind) {
  constexpr const char* kNames[] = {"input", "pipeline", "ablation", "baseline", "method"};
  return kNames[static_cast<size_t>(kind)];
}

const ResultRow* FindRow(const ClipResult& clip, const std::string& variant, const std::string& stage) {
  const auto row = std::ranges::find_if(
      clip.rows, [&](const ResultRow& row) { return row.variant == variant && row.stage == stage; });
  return row == clip.rows.end() ? nullptr : &*row;
}

Value GainOf(const ClipResult& clip, const std::string& variant, Measure measure, const std::string& stage) {
  const ResultRow *row = FindRow(clip, variant, stage), *input = FindRow(clip, kInputName);
  if (!row || !input || !row->measures[measure] || !input->measures[measure]) return {};
  return *row->measures[measure] - *input->measures[measure];
}

std::string StrengthOf(const ClipFacts& facts) {
  if (!facts.tilt_rms_px) return "";
  return *facts.tilt_rms_px < 0.71 ? "weak" : *facts.tilt_rms_px < 1.41 ? "medium" : "strong";
}

}  // namespace shimmer::restore::app
