#include "restore/app/evaluation/summary.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace shimmer::restore::app {
namespace {

// The 97.5 % point of Student's t for so many degrees of freedom: of few from tables, of more by the
// expansion about the normal distribution's, which is within 2e-4 of it from 4 on (Abramowitz &
// Stegun 26.7.5).
double StudentT(int degrees) {
  constexpr double kFew[] = {12.7062, 4.3027, 3.1824};
  if (degrees <= 3) return kFew[degrees - 1];
  const double x = 1.959963985, n = degrees, x2 = x * x;
  const double g1 = x * (x2 + 1) / 4, g2 = x * ((5 * x2 + 16) * x2 + 3) / 96,
               g3 = x * (((3 * x2 + 19) * x2 + 17) * x2 - 15) / 384,
               g4 = x * ((((79 * x2 + 776) * x2 + 1482) * x2 - 1920) * x2 - 945) / 92160;
  return x + (g1 + (g2 + (g3 + g4 / n) / n) / n) / n;
}

// From 1; equal numbers share the mean of theirs.
std::vector<double> Ranks(std::span<const double> values) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, {}, [&](size_t i) { return values[i]; });
  std::vector<double> ranks(values.size());
  for (size_t first = 0; first < order.size();) {
    size_t end = first;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (size_t i = first; i < end; ++i) ranks[order[i]] = (static_cast<double>(first + end) + 1) / 2;
    first = end;
  }
  return ranks;
}

using ValueOfClip = std::function<std::string(const ClipFacts&)>;

void AddGroups(const std::vector<ClipResult>& clips, const std::string& key,
               std::initializer_list<const char*> names, const ValueOfClip& value_of,
               std::vector<ClipGroup>& groups) {
  for (const char* name : names) {
    ClipGroup group{key, name, {}};
    for (const ClipResult& clip : clips)
      if (value_of(clip.facts) == name) group.clips.push_back(&clip);
    if (!group.clips.empty()) groups.push_back(std::move(group));
  }
}

}  // namespace

std::optional<MeanOfClips> MeanOf(std::span<const Value> values) {
  std::vector<double> there;
  for (const Value& value : values)
    if (value) there.push_back(*value);
  if (there.empty()) return {};
  const auto n = static_cast<double>(there.size());
  MeanOfClips result{.mean = std::accumulate(there.begin(), there.end(), 0.0) / n,
                     .margin = {},
                     .clips = static_cast<int>(there.size())};
  if (there.size() == 1 || !std::isfinite(result.mean)) return result;
  double squares = 0;
  for (const double value : there) squares += (value - result.mean) * (value - result.mean);
  result.margin = StudentT(result.clips - 1) * std::sqrt(squares / (n - 1) / n);
  return result;
}

std::vector<ClipGroup> GroupsOf(const std::vector<ClipResult>& clips) {
  std::vector<ClipGroup> groups;
  AddGroups(
      clips, "all", {""}, [](const ClipFacts&) { return ""; }, groups);
  AddGroups(clips, "strength", {"weak", "medium", "strong"}, StrengthOf, groups);
  AddGroups(
      clips, "shake", {"no", "yes"},
      [](const ClipFacts& facts) -> std::string {
        return !facts.shakes ? "?" : *facts.shakes ? "yes" : "no";
      },
      groups);
  AddGroups(
      clips, "objects", {"0", "1", "2", "3"},
      [](const ClipFacts& facts) { return facts.objects ? std::to_string(*facts.objects) : "?"; }, groups);
  return groups;
}

std::optional<MeanOfClips> MeanIn(const ClipGroup& group, const std::string& variant,
                                  const std::string& stage, Measure measure, bool gain) {
  std::vector<Value> values;
  for (const ClipResult* clip : group.clips) {
    const ResultRow* row = FindRow(*clip, variant, stage);
    values.push_back(gain ? GainOf(*clip, variant, measure, stage) : row ? row->measures[measure] : Value());
  }
  return MeanOf(values);
}

std::optional<double> RankCorrelation(std::span<const double> a, std::span<const double> b) {
  if (a.size() < 3) return {};
  const std::vector<double> ranks_a = Ranks(a), ranks_b = Ranks(b);
  const double mean = (static_cast<double>(a.size()) + 1) / 2;
  double product = 0, square_a = 0, square_b = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    product += (ranks_a[i] - mean) * (ranks_b[i] - mean);
    square_a += (ranks_a[i] - mean) * (ranks_a[i] - mean);
    square_b += (ranks_b[i] - mean) * (ranks_b[i] - mean);
  }
  if (square_a == 0 || square_b == 0) return {};
  return product / std::sqrt(square_a * square_b);
}

std::optional<double> TiltCorrelation(const std::vector<ClipResult>& clips) {
  std::vector<double> found, truth;
  for (const ClipResult& clip : clips) {
    const ResultRow* look = FindRow(clip, kFullName, "look");
    if (!look || !look->measures[Measure::kFoundTilt] || !clip.facts.tilt_rms_px) continue;
    found.push_back(*look->measures[Measure::kFoundTilt]);
    truth.push_back(*clip.facts.tilt_rms_px);
  }
  return RankCorrelation(found, truth);
}

}  // namespace shimmer::restore::app
