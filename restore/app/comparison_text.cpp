#include "restore/app/comparison_text.h"

#include <cmath>
#include <cstdio>

#include "cli/number_text.h"

namespace shimmer::restore::app {
namespace {

using Json = nlohmann::ordered_json;

struct Worst {
  Value value;
  int64_t frame = 0;
};

template <class Of>
std::vector<Value> Values(const Comparison& comparison, const Of& of) {
  std::vector<Value> values;
  for (const FrameScores& scores : comparison.frames) values.push_back(of(scores));
  return values;
}

// The first of those that are least.
Worst WorstOf(std::span<const Value> values) {
  Worst worst;
  for (size_t i = 0; i < values.size(); ++i)
    if (values[i] && (!worst.value || *values[i] < *worst.value))
      worst = {values[i], static_cast<int64_t>(i)};
  return worst;
}

// Of A (0) or B (1).
struct OwnValues {
  std::vector<Value> deviation_deg, difference_levels;
  std::vector<std::optional<Spread>> rolling;
  Value mean_deviation_deg, rolling_spread_deg, mean_difference_levels;
};

OwnValues OwnValuesOf(const Comparison& comparison, size_t which) {
  OwnValues own;
  own.deviation_deg =
      Values(comparison, [&](const FrameScores& scores) { return scores.line_deviation_deg[which]; });
  if (which == 1 && comparison.b_is_still) own.deviation_deg.resize(1);
  own.difference_levels =
      Values(comparison, [&](const FrameScores& scores) { return scores.difference_levels[which]; });
  own.rolling = Rolling(own.deviation_deg, kRollingFrames);
  std::vector<Value> spreads;
  for (const auto& spread : own.rolling)
    if (spread) spreads.emplace_back(spread->standard_deviation);
  own.mean_deviation_deg = MeanOfPresent(own.deviation_deg);
  if (own.deviation_deg.size() > 1) own.rolling_spread_deg = MeanOfPresent(spreads);  // one picture has none
  own.mean_difference_levels = MeanOfPresent(own.difference_levels);
  return own;
}

std::string Text(Value value, int decimals) {
  if (!value) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, *value);
  return text;
}

// A label and figures in columns.
std::string Row(const std::string& label, std::initializer_list<std::string> figures) {
  char text[80];
  std::snprintf(text, sizeof text, "%-20s", label.c_str());
  std::string row = text;
  for (const std::string& figure : figures) {
    std::snprintf(text, sizeof text, "%10s", figure.c_str());
    row += text;
  }
  return row + "\n";
}

Json ValueJson(Value value) {
  if (!value) return nullptr;
  if (std::isinf(*value)) return *value > 0 ? "inf" : "-inf";
  return *value;
}

Json SequenceJson(const Comparison& comparison, size_t which, const std::string& path, const OwnValues& own) {
  Json json = {{"path", path},
               {"frames", which == 1 && comparison.b_is_still ? 1 : comparison.frames.size()}};
  if (comparison.are_masks) return json;
  json["line_deviation_deg"] = ValueJson(own.mean_deviation_deg);
  json["line_deviation_rolling_sd_deg"] = ValueJson(own.rolling_spread_deg);
  json["stability_levels"] = ValueJson(own.mean_difference_levels);
  return json;
}

// The values of one frame, for B those that it has.
Json OwnFrameJson(const OwnValues& own, size_t frame) {
  const bool seen = frame < own.rolling.size() && own.rolling[frame];
  return {{"line_deviation_deg",
           ValueJson(frame < own.deviation_deg.size() ? own.deviation_deg[frame] : Value())},
          {"line_deviation_rolling_mean_deg", ValueJson(seen ? Value(own.rolling[frame]->mean) : Value())},
          {"line_deviation_rolling_sd_deg",
           ValueJson(seen ? Value(own.rolling[frame]->standard_deviation) : Value())},
          {"difference_levels", ValueJson(own.difference_levels[frame])}};
}

}  // namespace

std::string ComparisonTable(const Comparison& comparison, const std::string& a, const std::string& b) {
  const auto count = std::ssize(comparison.frames);
  const std::string size =
      std::to_string(comparison.size.width) + "x" + std::to_string(comparison.size.height) + " px";
  std::string table = "A: " + a + ", " + cli::Counted(count, "frame") + " of " + size + "\n";
  table += "B: " + b + ", " + cli::Counted(comparison.b_is_still ? 1 : count, "frame") + "\n\n";
  table += Row("A against B", {"mean", "worst", "in frame"});
  for (const Score& score : comparison.scores()) {
    const auto values = Values(comparison, [&](const FrameScores& scores) { return scores.*score.value; });
    const Worst worst = WorstOf(values);
    table += Row(score.label, {Text(MeanOfPresent(values), score.decimals), Text(worst.value, score.decimals),
                               worst.value ? std::to_string(worst.frame) : "-"});
  }
  if (comparison.are_masks) return table;
  const OwnValues own_a = OwnValuesOf(comparison, 0), own_b = OwnValuesOf(comparison, 1);
  table += "\n" + Row("each alone", {"A", "B"});
  table += Row("line deviation, deg", {Text(own_a.mean_deviation_deg, 2), Text(own_b.mean_deviation_deg, 2)});
  table += Row("  its rolling sd", {Text(own_a.rolling_spread_deg, 2), Text(own_b.rolling_spread_deg, 2)});
  table += Row("stability, levels",
               {Text(own_a.mean_difference_levels, 3), Text(own_b.mean_difference_levels, 3)});
  return table;
}

Json ComparisonJson(const Comparison& comparison, const std::string& a, const std::string& b) {
  const size_t count = comparison.frames.size();
  const OwnValues own_a = OwnValuesOf(comparison, 0), own_b = OwnValuesOf(comparison, 1);
  Json mean, worst, frames = Json::array();
  for (const Score& score : comparison.scores()) {
    const auto values = Values(comparison, [&](const FrameScores& scores) { return scores.*score.value; });
    const Worst least = WorstOf(values);
    mean[score.name] = ValueJson(MeanOfPresent(values));
    worst[score.name] = {{"value", ValueJson(least.value)},
                         {"frame", least.value ? Json(least.frame) : Json(nullptr)}};
  }
  for (size_t i = 0; i < count; ++i) {
    Json frame = {{"frame", i}};
    for (const Score& score : comparison.scores())
      frame[score.name] = ValueJson(comparison.frames[i].*score.value);
    if (!comparison.are_masks) {
      frame["a"] = OwnFrameJson(own_a, i);
      frame["b"] = OwnFrameJson(own_b, i);
    }
    frames.push_back(frame);
  }
  return {{"size", {comparison.size.width, comparison.size.height}},
          {"a", SequenceJson(comparison, 0, a, own_a)},
          {"b", SequenceJson(comparison, 1, b, own_b)},
          {"mean", mean},
          {"worst", worst},
          {"frames", frames}};
}

}  // namespace shimmer::restore::app
