#include "sim/app/report_facts.h"

#include <algorithm>
#include <cmath>

namespace shimmer::app {
namespace {

// Beyond it lies no value of any key, and arithmetic with bins and ticks would overflow.
constexpr double kMostNumber = 1e100;

// A member of a line; null if it has none, or is no object.
const Json& Member(const Json& object, const char* name) {
  static const Json kAbsent;
  if (!object.is_object()) return kAbsent;
  const auto found = object.find(name);
  return found == object.end() ? kAbsent : *found;
}

void AddDone(const Json& line, ReportFacts& facts) {
  if (const Json& drawn = Member(line, "drawn"); drawn.is_object())
    for (const auto& [key, value] : drawn.items()) facts.drawn[key].Add(value);
  facts.tilt_rms_px.Add(Member(line, "tilt_rms_px"));
  facts.mean_sigma_px.Add(Member(line, "mean_sigma_px"));
  facts.shake_rms_px.Add(Member(line, "shake_rms_px"));
  facts.moving_share.Add(Member(line, "moving_share"));
  if (const Json& path = Member(Member(line, "source"), "path"); path.is_string())
    ++facts.clips_of_source[path.get_ref<const std::string&>()];
  for (const Json& file : Member(line, "files"))
    if (const Json& bytes = Member(file, "bytes"); bytes.is_number_unsigned())
      facts.file_bytes += bytes.get<uint64_t>();
}

void AddFailed(const Json& line, ReportFacts& facts) {
  const Json& error = Member(line, "error");
  Failure& failure = facts.failures[error.is_string() ? error.get<std::string>() : "no error is noted"];
  ++failure.clips;
  if (failure.first_clips.size() < kFirstClips)
    failure.first_clips.push_back(Member(line, "clip").get<int64_t>());
}

}  // namespace

std::string ValueText(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_array() && value.size() == 2) return value[0].dump() + "x" + value[1].dump();
  return value.is_number_float() ? sim::NumberText(value.get<double>()) : value.dump();
}

void Values::Add(const Json& value) {
  if (value.is_null()) return;
  if (!value.is_number())
    ++others[ValueText(value)];
  else if (const double number = value.get<double>(); std::abs(number) <= kMostNumber)
    numbers.push_back(number);
}

SourceCounts CountSources(const Json& sources) {
  SourceCounts counts;
  for (const Json& source : sources) {
    const bool other = source.is_object() && (source.contains("mask_of") || source.contains("object"));
    ++(other ? counts.masks_and_objects : counts.backgrounds);
  }
  return counts;
}

ReportFacts FactsOf(const dataset::DatasetReader& reader) {
  ReportFacts facts;
  reader.manifest().ForEachLine([&](int64_t, const Json& line) {
    if (Member(line, "status") == "done")
      AddDone(line, facts);
    else
      AddFailed(line, facts);
  });
  for (auto& [key, values] : facts.drawn) std::ranges::sort(values.numbers);
  for (Values* values : {&facts.tilt_rms_px, &facts.mean_sigma_px, &facts.shake_rms_px, &facts.moving_share})
    std::ranges::sort(values->numbers);
  return facts;
}

}  // namespace shimmer::app
