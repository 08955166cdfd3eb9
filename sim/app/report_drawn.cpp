#include "sim/app/report_drawn.h"

#include <algorithm>

#include "sim/app/config/distribution.h"
#include "sim/app/config/keys.h"
#include "sim/app/report_charts.h"

namespace shimmer::app {
namespace {

// "[2, 8]"
std::string ListText(const Json& numbers) {
  std::string text;
  for (const Json& number : numbers) text += (text.empty() ? "" : ", ") + ValueText(number);
  return "[" + text + "]";
}

// "uniform [2, 8]", "normal [2, 1], clip [0.5, 6]", "choice of 5", "choice of 2, weights [3, 1]"
std::string DistributionText(const Json& distribution) {
  if (distribution.contains(kChoice)) {
    const Json& weights = distribution.at(kWeights);
    const bool equal = std::ranges::all_of(weights, [&](const Json& w) { return w == weights.front(); });
    const std::string text = "choice of " + std::to_string(distribution.at(kChoice).size());
    return equal || weights.size() > kMostBars ? text : text + ", weights " + ListText(weights);
  }
  for (const char* name : {kUniform, kLogUniform, kNormal})
    if (distribution.contains(name)) {
      const std::string text = std::string(name) + " " + ListText(distribution.at(name));
      return distribution.contains(kClip) ? text + ", clip " + ListText(distribution.at(kClip)) : text;
    }
  return distribution.dump();
}

// How often each value is there: of a choice that can be shown whole in its order, also what was never drawn;
// of others the most frequent first.
std::vector<BarRow> RowsOf(const Values& values, const Json& distribution) {
  std::map<std::string, int64_t> counts = values.others;
  for (const double number : values.numbers) ++counts[ValueText(number)];
  std::vector<BarRow> rows;
  const Json choice = distribution.value(kChoice, Json::array());
  if (choice.size() <= kMostBars) {
    for (const Json& value : choice) {
      const std::string text = ValueText(value);
      const auto count = counts.find(text);
      rows.push_back({text, count == counts.end() ? 0 : count->second});
      if (count != counts.end()) counts.erase(count);
    }
  }
  const size_t in_order = rows.size();
  for (const auto& [text, count] : counts) rows.push_back({text, count});
  std::stable_sort(rows.begin() + static_cast<std::ptrdiff_t>(in_order), rows.end(),
                   [](const BarRow& a, const BarRow& b) { return a.count > b.count; });
  return rows;
}

std::string ChartOf(const Key& key, const Json& distribution, const Values& values) {
  const ChartTexts texts{
      .key = key.path, .unit = key.field.unit, .notes = {key.field.help, DistributionText(distribution)}};
  if (distribution.contains(kChoice) || !values.others.empty())
    return BarsHtml(texts, RowsOf(values, distribution));
  const cli::AxisKind kind = key.kind == Kind::kInteger           ? cli::AxisKind::kWhole
                             : distribution.contains(kLogUniform) ? cli::AxisKind::kLogarithmic
                                                                  : cli::AxisKind::kLinear;
  return HistogramHtml(texts, values.numbers, kind);
}

Values ValuesOf(const ReportFacts& facts, const std::string& path) {
  const auto values = facts.drawn.find(path);
  return values == facts.drawn.end() ? Values() : values->second;
}

std::string ObjectsHtml(const Key& list, const Json& resolved, const ReportFacts& facts);

std::string ChartsOf(const Key& section, const Json& resolved, const ReportFacts& facts) {
  std::string html;
  for (const Key& key : section.keys) {
    const auto value = resolved.find(key.name());
    if (value == resolved.end()) continue;
    if (key.kind == Kind::kSection)
      html += ChartsOf(key, *value, facts);
    else if (key.kind == Kind::kList)
      html += ObjectsHtml(key, *value, facts);
    else if (value->is_object())
      html += ChartOf(key, *value, ValuesOf(facts, key.path));
  }
  return html;
}

std::string ObjectsHtml(const Key& list, const Json& resolved, const ReportFacts& facts) {
  std::string html;
  for (size_t i = 0; i < resolved.size(); ++i) {
    const Key object = ElementOf(list, i);
    if (const Json& chance = resolved[i].at("chance"); chance.is_object() || (chance > 0 && chance < 1)) {
      const ChartTexts texts{
          .key = object.path + ".present",
          .unit = "",
          .notes = {"whether it is in the clip",
                    "chance " + (chance.is_object() ? DistributionText(chance) : ValueText(chance))}};
      html += BarsHtml(texts, RowsOf(ValuesOf(facts, texts.key), {{kChoice, {true, false}}}));
    }
    html += ChartsOf(object, resolved[i], facts);
  }
  return html;
}

}  // namespace

std::string DrawnChartsHtml(const ConfigFile& config, const ReportFacts& facts) {
  return ChartsOf(AllKeys(), config.resolved(), facts);
}

}  // namespace shimmer::app
