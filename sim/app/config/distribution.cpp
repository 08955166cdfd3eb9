#include "sim/app/config/distribution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sim/app/config/value.h"

namespace shimmer::app {
namespace {

// Beyond this many sd from the mean a normal distribution holds less than 1e-9 of its mass, and a clip there
// is taken for a mistake.
constexpr double kFarthestClipSds = 6;

// The one form that a distribution has.
const DistributionForm& FormOf(const Key& key, const Json& distribution, const std::string& pointer) {
  std::vector<std::string> known;
  const DistributionForm* form = nullptr;
  for (const DistributionForm& candidate : kDistributionForms) {
    known.push_back(candidate.name);
    if (*candidate.companion) known.push_back(candidate.companion);
    if (!distribution.contains(candidate.name)) continue;
    if (form)
      throw ConfigError(pointer, "has both '" + std::string(form->name) + "' and '" + candidate.name +
                                     "', must have one of them");
    form = &candidate;
  }
  known.push_back(kAs);
  for (const auto& [name, value] : distribution.items()) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw ConfigError(PointerUnder(pointer, name), UnknownKey(name, known));
    if (form && name != form->name && name != form->companion && name != kAs)
      throw ConfigError(PointerUnder(pointer, name),
                        "has no meaning beside '" + std::string(form->name) + "'");
  }
  if (!form)
    throw ConfigError(pointer,
                      "is " + Shown(distribution) + ", must be " + Wanted(key) + ", or a distribution");
  return *form;
}

// [a, b] of the key's own kind and range, a <= b.
Json CheckedEnds(const Key& key, const Json& ends, const std::string& pointer) {
  if (!ends.is_array() || ends.size() != 2)
    throw ConfigError(pointer, "is " + Shown(ends) + ", must be [a, b], each " + Wanted(key));
  Json checked = Json::array();
  for (size_t i = 0; i < 2; ++i) checked.push_back(CheckedLiteral(key, ends[i], PointerUnder(pointer, i)));
  if (checked[0] > checked[1])
    throw ConfigError(pointer, "is " + Shown(ends) + ", must be [a, b] with a not greater than b");
  return checked;
}

Json CheckedLogUniform(const Key& key, const Json& distribution, const std::string& pointer) {
  const std::string here = PointerUnder(pointer, kLogUniform);
  const Json ends = CheckedEnds(key, distribution[kLogUniform], here);
  if (ends[0].get<double>() < std::numeric_limits<double>::min())  // its logarithm is none, or not exact
    throw ConfigError(PointerUnder(here, size_t{0}), "is " + Shown(ends[0]) + ", must be greater than 0");
  return {{kLogUniform, ends}};
}

Json CheckedNormal(const Key& key, const Json& distribution, const std::string& pointer) {
  const std::string here = PointerUnder(pointer, kNormal);
  const Json& normal = distribution[kNormal];
  const bool numbers =
      normal.is_array() && normal.size() == 2 && normal[0].is_number() && normal[1].is_number();
  if (!numbers || normal[1].get<double>() < 0)
    throw ConfigError(here, "is " + Shown(normal) + ", must be [mean, sd], two numbers, sd at least 0");
  const double mean = normal[0].get<double>() + 0.0, sd = normal[1].get<double>();

  Json clip = Json::array({key.low, key.high});
  if (distribution.contains(kClip))
    clip = CheckedEnds(key, distribution[kClip], PointerUnder(pointer, kClip));
  else if (key.low.is_null() || key.high.is_null())
    throw ConfigError(pointer, "needs \"clip\": [a, b], since " + key.path + " has no range of its own");
  const Support ends = SupportOf({{kUniform, clip}});
  if (mean + kFarthestClipSds * sd < ends.low || mean - kFarthestClipSds * sd > ends.high)
    throw ConfigError(here,
                      "is " + Shown(normal) + ", must have its mean within 6 sd of the clip " + Shown(clip));
  return {{kNormal, {mean, sd}}, {kClip, clip}};
}

Json CheckedWeights(const Json& weights, size_t count, const std::string& pointer) {
  if (!weights.is_array() || weights.size() != count)
    throw ConfigError(pointer, "is " + Shown(weights) + ", must be a list of " + std::to_string(count) +
                                   " numbers, as many as choices");
  double sum = 0;
  Json checked = Json::array();
  for (size_t i = 0; i < count; ++i) {
    if (!weights[i].is_number() || weights[i].get<double>() < 0)
      throw ConfigError(PointerUnder(pointer, i),
                        "is " + Shown(weights[i]) + ", must be a number of at least 0");
    checked.push_back(weights[i].get<double>() + 0.0);
    sum += checked.back().get<double>();
  }
  if (!(sum > 0 && std::isfinite(sum)))
    throw ConfigError(pointer, "is " + Shown(weights) + ", must have a finite sum greater than 0");
  return checked;
}

Json CheckedChoice(const Key& key, const Json& distribution, const std::string& pointer) {
  const std::string here = PointerUnder(pointer, kChoice);
  const Json& options = distribution[kChoice];
  if (!options.is_array() || options.empty())
    throw ConfigError(here, "is " + Shown(options) + ", must be a list of at least one value");
  Json checked = Json::array();
  for (size_t i = 0; i < options.size(); ++i)
    checked.push_back(CheckedLiteral(key, options[i], PointerUnder(here, i)));
  const Json weights =
      distribution.contains(kWeights)
          ? CheckedWeights(distribution[kWeights], options.size(), PointerUnder(pointer, kWeights))
          : Json(std::vector<double>(options.size(), 1.0));
  return {{kChoice, checked}, {kWeights, weights}};
}

int64_t Whole(double number, const Json& low, const Json& high) {
  return std::clamp(static_cast<int64_t>(std::floor(number)), low.get<int64_t>(), high.get<int64_t>());
}

}  // namespace

bool DrawsNumbers(const Key& key) {
  return (key.kind == Kind::kReal || key.kind == Kind::kInteger) && key.field.values.empty();
}

Json CheckedDistribution(const Key& key, const Json& distribution, const std::string& pointer) {
  if (!key.field.per_clip)
    throw ConfigError(pointer, "is " + Shown(distribution) + ", but holds for the whole data set: must be " +
                                   Wanted(key) + ", no distribution");
  const std::string form = FormOf(key, distribution, pointer).name;
  if (form != kChoice && !DrawsNumbers(key))
    throw ConfigError(PointerUnder(pointer, form),
                      "does not fit what is " + Wanted(key) + ": must be \"choice\"");
  Json checked;
  if (form == kChoice)
    checked = CheckedChoice(key, distribution, pointer);
  else if (form == kNormal)
    checked = CheckedNormal(key, distribution, pointer);
  else if (form == kLogUniform)
    checked = CheckedLogUniform(key, distribution, pointer);
  else
    checked = {{kUniform, CheckedEnds(key, distribution[kUniform], PointerUnder(pointer, kUniform))}};
  if (distribution.contains(kAs)) {
    const Json& label = distribution[kAs];
    if (!label.is_string() || label.get_ref<const std::string&>().empty())
      throw ConfigError(PointerUnder(pointer, kAs),
                        "is " + Shown(label) + ", must be a text that is not empty");
    checked[kAs] = label;
  }
  return checked;
}

Support SupportOf(const Json& value) {
  if (value.is_number()) return {value.get<double>(), value.get<double>()};
  const auto ends = [&](const char* name) {
    return Support{value[name][0].get<double>(), value[name][1].get<double>()};
  };
  if (value.contains(kUniform)) return ends(kUniform);
  if (value.contains(kLogUniform)) return ends(kLogUniform);
  if (value.contains(kNormal)) return ends(kClip);
  const auto options = value[kChoice].get<std::vector<double>>();
  const auto [low, high] = std::minmax_element(options.begin(), options.end());
  return {*low, *high};
}

double LargestOf(const Json& value) { return SupportOf(value).high; }

cv::Size LargestSizeOf(const Json& value) {
  cv::Size largest;
  for (const Json& size : value.is_object() ? value.at(kChoice) : Json::array({value})) {
    largest.width = std::max(largest.width, size.at(0).get<int>());
    largest.height = std::max(largest.height, size.at(1).get<int>());
  }
  return largest;
}

bool MayBe(const Json& value, const std::string& name) {
  if (!value.is_object()) return value == name;
  return std::ranges::find(value.at(kChoice), Json(name)) != value.at(kChoice).end();
}

Json DrawFrom(const Key& key, const Json& distribution, sim::ClipKey clip) {
  const std::string path = distribution.value(kAs, key.path);
  if (distribution.contains(kChoice)) {
    const auto weights = distribution[kWeights].get<std::vector<double>>();
    return distribution[kChoice][sim::DrawIndex(clip, path, weights)];
  }
  const bool whole = key.kind == Kind::kInteger;
  if (distribution.contains(kNormal)) {
    const double mean = distribution[kNormal][0], sd = distribution[kNormal][1];
    const Json &low = distribution[kClip][0], &high = distribution[kClip][1];
    if (!whole) return sim::DrawNormal(clip, path, mean, sd, low, high);
    // A whole number stands for all that rounds to it.
    const double number =
        sim::DrawNormal(clip, path, mean, sd, low.get<double>() - 0.5, high.get<double>() + 0.5);
    return Whole(number + 0.5, low, high);
  }
  if (distribution.contains(kLogUniform)) {
    const Json &low = distribution[kLogUniform][0], &high = distribution[kLogUniform][1];
    if (!whole) return sim::DrawLogUniform(clip, path, low, high);
    // A whole number n stands for [n, n + 1), so that both ends are drawn.
    return Whole(sim::DrawLogUniform(clip, path, low.get<double>(), high.get<double>() + 1), low, high);
  }
  const Json &low = distribution[kUniform][0], &high = distribution[kUniform][1];
  if (!whole) return sim::DrawUniform(clip, path, low, high);
  return sim::DrawInteger(clip, path, low, high);
}

}  // namespace shimmer::app
