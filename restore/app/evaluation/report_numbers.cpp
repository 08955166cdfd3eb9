#include "restore/app/evaluation/report_numbers.h"

#include <cmath>
#include <cstdio>

namespace shimmer::restore::app {

std::string Shown(const Value& value, int decimals, Sign sign) {
  if (!value || std::isnan(*value)) return kAbsent;
  if (std::isinf(*value)) return *value > 0 ? "inf" : "-inf";
  char digits[40];
  const double size = std::abs(*value);
  std::snprintf(digits, sizeof digits, size < 1e7 ? "%.*f" : "%.*g", decimals + (size < 1e7 ? 0 : 1), size);
  const std::string text = digits;
  if (text.find_first_of("123456789") == std::string::npos) return text;  // no "-0.00"
  return (*value < 0 ? "-" : sign == Sign::kAlways ? "+" : "") + text;
}

std::string ShownWithUnit(const Value& value, const MeasureText& text, Sign sign) {
  const std::string number = Shown(value, text.decimals, sign), unit = text.unit;
  return unit.empty() || number == kAbsent ? number : number + " " + unit;
}

std::string MarginText(const std::optional<MeanOfClips>& mean, int decimals) {
  return mean && mean->margin ? "±\u00A0" + Shown(*mean->margin, decimals) : "";
}

std::string Exact(double value) {
  if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

Value MeanAlone(const std::optional<MeanOfClips>& mean) { return mean ? Value(mean->mean) : Value(); }

ClipGroup AllOf(const std::vector<ClipResult>& clips) {
  ClipGroup all{"all", "", {}};
  for (const ClipResult& clip : clips) all.clips.push_back(&clip);
  return all;
}

Value Found(const ClipResult& clip, Measure measure) {
  for (const ResultRow& row : clip.rows)
    if (row.variant == kFullName && row.measures[measure]) return row.measures[measure];
  return {};
}

std::optional<MeanOfClips> MeanFound(const ClipGroup& group, Measure measure) {
  std::vector<Value> values;
  for (const ClipResult* clip : group.clips) values.push_back(Found(*clip, measure));
  return MeanOf(values);
}

Value FullGain(const ClipResult& clip) {
  const Value gain = GainOf(clip, kFullName, Measure::kPsnr);
  return gain && std::isnan(*gain) ? Value() : gain;
}

}  // namespace shimmer::restore::app
