#include "restore/app/evaluation/result_text.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "cli/number_text.h"
#include "restore/app/evaluation/summary.h"

namespace shimmer::restore::app {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

OrderedJson ValueJson(const Value& value) {
  if (!value || std::isnan(*value)) return nullptr;
  if (std::isinf(*value)) return *value > 0 ? "inf" : "-inf";
  return *value;
}

Value ValueOf(const nlohmann::json& json) {
  if (json.is_null()) return {};
  if (json.is_string()) return json == "inf" ? kInfinity : -kInfinity;
  return json.get<double>();
}

template <class T>
std::optional<T> Optional(const nlohmann::json& json, const char* key) {
  return json.at(key).is_null() ? std::nullopt : std::optional(json.at(key).get<T>());
}

template <class T>
OrderedJson OrNull(const std::optional<T>& value) {
  return value ? OrderedJson(*value) : OrderedJson(nullptr);
}

OrderedJson ClipJson(const ClipResult& clip) {
  OrderedJson json = FactsJson(clip.facts);
  json["rows"] = RowsJson(clip.rows);
  json["errors"] = OrderedJson::array();
  for (const VariantError& error : clip.errors)
    json["errors"].push_back({{"variant", error.variant}, {"error", error.error}});
  return json;
}

// Of the rows of a variant and stage, in a group of clips: each measure's mean, and its mean gain over the
// input.
OrderedJson MeansJson(const ClipGroup& group, const std::string& variant, const std::string& stage) {
  OrderedJson means = OrderedJson::object(), gains = OrderedJson::object();
  for (size_t i = 0; i < kMeasureCount; ++i) {
    const auto measure = static_cast<Measure>(i);
    const auto add = [&](OrderedJson& to, bool gain) {
      const auto mean = MeanIn(group, variant, stage, measure, gain);
      if (mean)
        to[TextOf(measure).name] = {
            {"mean", ValueJson(mean->mean)}, {"margin_95", ValueJson(mean->margin)}, {"clips", mean->clips}};
    };
    add(means, false);
    if (variant != kInputName) add(gains, true);
  }
  if (means.empty()) return nullptr;
  return {{"group", group.key}, {"value", group.value}, {"variant", variant},
          {"stage", stage},     {"means", means},       {"gains_over_input", gains}};
}

OrderedJson SummaryJson(const Evaluation& evaluation) {
  OrderedJson summary = OrderedJson::array();
  for (const ClipGroup& group : GroupsOf(evaluation.clips))
    for (const VariantText& variant : evaluation.variants) {
      if (variant.name == kFullName)
        for (const char* stage : kStageNames)
          if (OrderedJson means = MeansJson(group, variant.name, stage); !means.is_null())
            summary.push_back(std::move(means));
      if (OrderedJson means = MeansJson(group, variant.name, kResultStage); !means.is_null())
        summary.push_back(std::move(means));
    }
  return summary;
}

std::string CsvText(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string CsvNumber(const Value& value) {
  if (!value) return "";
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", *value);
  return text;
}

void AddCsv(const std::vector<ClipResult>& clips, const char* kind, std::string& csv) {
  for (const ClipResult& clip : clips) {
    const ClipFacts& facts = clip.facts;
    const std::string head = CsvText(facts.name) + "," + kind + "," + std::to_string(facts.frames) + "," +
                             std::to_string(facts.size.width) + "," + std::to_string(facts.size.height) +
                             "," + CsvNumber(facts.tilt_rms_px) + "," + StrengthOf(facts) + "," +
                             (facts.shakes ? (*facts.shakes ? "yes" : "no") : "") + "," +
                             (facts.objects ? std::to_string(*facts.objects) : "");
    for (const ResultRow& row : clip.rows) {
      csv += head + "," + row.variant + "," + row.stage;
      for (size_t i = 0; i < kMeasureCount; ++i)
        csv += "," + CsvNumber(row.measures[static_cast<Measure>(i)]);
      csv += "\n";
    }
  }
}

std::string Padded(const std::string& text, size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text + " ";
}

}  // namespace

OrderedJson FactsJson(const ClipFacts& facts) {
  return {{"clip", facts.name},
          {"frames", facts.frames},
          {"size", {facts.size.width, facts.size.height}},
          {"tilt_rms_px", OrNull(facts.tilt_rms_px)},
          {"shakes", OrNull(facts.shakes)},
          {"objects", OrNull(facts.objects)}};
}

ClipFacts FactsOf(const nlohmann::json& json) {
  return {.name = json.at("clip"),
          .frames = json.at("frames"),
          .size = {json.at("size").at(0), json.at("size").at(1)},
          .tilt_rms_px = Optional<double>(json, "tilt_rms_px"),
          .shakes = Optional<bool>(json, "shakes"),
          .objects = Optional<int>(json, "objects")};
}

OrderedJson RowsJson(const std::vector<ResultRow>& rows) {
  OrderedJson json = OrderedJson::array();
  for (const ResultRow& row : rows) {
    OrderedJson each = {{"variant", row.variant}, {"stage", row.stage}};
    for (size_t i = 0; i < kMeasureCount; ++i)
      if (const Value value = row.measures[static_cast<Measure>(i)])
        each[kMeasureTexts[i].name] = ValueJson(value);
    json.push_back(std::move(each));
  }
  return json;
}

std::vector<ResultRow> RowsOf(const nlohmann::json& json) {
  std::vector<ResultRow> rows;
  for (const nlohmann::json& each : json) {
    ResultRow row{each.at("variant"), each.at("stage"), {}};
    for (size_t i = 0; i < kMeasureCount; ++i)
      if (const auto value = each.find(kMeasureTexts[i].name); value != each.end())
        row.measures[static_cast<Measure>(i)] = ValueOf(*value);
    rows.push_back(std::move(row));
  }
  return rows;
}

OrderedJson ResultsJson(const Evaluation& evaluation) {
  OrderedJson json = {{"format", 1},
                      {"set", evaluation.set},
                      {"clips_of_set", evaluation.clips_of_set},
                      {"variants", OrderedJson::array()},
                      {"tilt_rank_correlation", ValueJson(TiltCorrelation(evaluation.clips))},
                      {"summary", SummaryJson(evaluation)},
                      {"clips", OrderedJson::array()},
                      {"real", OrderedJson::array()}};
  for (const VariantText& variant : evaluation.variants)
    json["variants"].push_back(
        {{"name", variant.name}, {"kind", NameOf(variant.kind)}, {"settings", variant.settings}});
  for (const ClipResult& clip : evaluation.clips) json["clips"].push_back(ClipJson(clip));
  for (const ClipResult& clip : evaluation.real) json["real"].push_back(ClipJson(clip));
  return json;
}

std::string ResultsCsv(const Evaluation& evaluation) {
  std::string csv = "clip,kind,frames,width,height,tilt_rms_px,strength,shakes,objects,variant,stage";
  for (const MeasureText& text : kMeasureTexts) csv += std::string(",") + text.name;
  csv += "\n";
  AddCsv(evaluation.clips, "truth", csv);
  AddCsv(evaluation.real, "real", csv);
  return csv;
}

std::string ResultsTable(const Evaluation& evaluation) {
  const std::vector<ClipGroup> groups = GroupsOf(evaluation.clips);
  if (groups.empty()) return "";
  struct Column {
    const char* title;
    Measure measure;
    bool gain;
  };
  constexpr Column kColumns[] = {{"PSNR dB", Measure::kPsnr, false},
                                 {"gain dB", Measure::kPsnr, true},
                                 {"background", Measure::kPsnrBackground, true},
                                 {"foreground", Measure::kPsnrForeground, true},
                                 {"SSIM", Measure::kSsim, false},
                                 {"IoU", Measure::kIou, false},
                                 {"ms a frame", Measure::kTime, false}};
  std::string table = Padded("", 18);
  for (const Column& column : kColumns) table += Padded(column.title, 12);
  table += "\n";
  for (const VariantText& variant : evaluation.variants) {
    table += Padded(variant.name, 18);
    for (const Column& column : kColumns) {
      const auto mean = MeanIn(groups.front(), variant.name, kResultStage, column.measure, column.gain);
      char text[32] = "-";
      if (mean && !(column.gain && variant.name == kInputName))
        std::snprintf(text, sizeof text, column.gain ? "%+.*f" : "%.*f", TextOf(column.measure).decimals,
                      mean->mean);
      table += Padded(text, 12);
    }
    while (table.back() == ' ') table.pop_back();
    table += "\n";
  }
  return table;
}

}  // namespace shimmer::restore::app
