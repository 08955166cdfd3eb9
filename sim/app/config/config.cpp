#include "sim/app/config/config.h"

#include <algorithm>

#include "sim/app/config/distribution.h"
#include "sim/app/config/hash.h"
#include "sim/app/config/json_reader.h"
#include "sim/app/config/keys.h"
#include "sim/app/config/rules.h"
#include "sim/app/config/sets.h"
#include "sim/app/config/value.h"
#include "sim/dataset/sha256.h"

namespace shimmer::app {
namespace {

constexpr int kExrBits = 16;  // where the config does not say; half is what most tools read

Json Checked(const Key& key, const Json& value) {
  return value.is_object() ? CheckedDistribution(key, value, key.pointer)
                           : CheckedLiteral(key, value, key.pointer);
}

Json Resolved(const Key& section, const Json& given);

Json ResolvedList(const Key& list, const Json& given) {
  if (!given.is_array() || given.size() > list.high.get<size_t>())
    throw ConfigError(list.pointer, "is " + Shown(given) + ", must be " + Wanted(list));
  Json resolved = Json::array();
  for (size_t i = 0; i < given.size(); ++i) resolved.push_back(Resolved(ElementOf(list, i), given[i]));
  return resolved;
}

// The section with each value checked, and with the default of each that is not given.
Json Resolved(const Key& section, const Json& given) {
  RequireObject(given, section.pointer);
  const std::vector<std::string> names = KeyNames(section);
  for (const auto& [name, value] : given.items())
    if (std::find(names.begin(), names.end(), name) == names.end()) throw NoSuchKey(section, name);

  Json resolved = Json::object();
  for (const Key& key : section.keys) {
    const auto found = given.find(key.name());
    const bool is_given = found != given.end();
    if (key.kind == Kind::kSection)
      resolved[key.name()] = Resolved(key, is_given ? *found : Json::object());
    else if (key.kind == Kind::kList)
      resolved[key.name()] = ResolvedList(key, is_given ? *found : Json::array());
    else if (is_given)
      resolved[key.name()] = Checked(key, *found);
    else if (!key.field.alternative)
      resolved[key.name()] = key.fallback;
  }
  return resolved;
}

// Puts a drawn value in the place of each distribution.
void DrawAll(const Key& section, sim::ClipKey clip, Json& values, Json& drawn) {
  for (const Key& key : section.keys) {
    const auto value = values.find(key.name());
    if (key.kind == Kind::kList)
      for (size_t i = 0; i < value->size(); ++i) DrawAll(ElementOf(key, i), clip, (*value)[i], drawn);
    if (value == values.end() || !value->is_object()) continue;
    if (key.kind == Kind::kSection)
      DrawAll(key, clip, *value, drawn);
    else
      *value = drawn[key.path] = DrawFrom(key, *value, clip);
  }
}

}  // namespace

ConfigFile ConfigFile::Parse(const std::string& text, std::span<const std::string> sets) {
  Json given = ReadJson(text);
  RequireObject(given, "");
  for (const std::string& set : sets) ApplySet(set, given);

  ConfigFile file;
  file.resolved_ = Resolved(AllKeys(), given);
  Fill(file.resolved_, file.fixed_);
  const Json::json_pointer bits(KeyOf(DefaultConfig().output.bits).pointer);
  if (file.fixed_.output.format == Format::kExr && !given.contains(bits))
    file.resolved_[bits] = file.fixed_.output.bits = kExrBits;
  CheckRules(file.resolved_, file.fixed_);
  return file;
}

cv::Size ConfigFile::LargestSize() const {
  return LargestSizeOf(resolved_.at(KeyOf(DefaultConfig().size).name()));
}

Config ConfigFile::Draw(uint64_t clip, Json* drawn) const {
  Json values = resolved_, draws = Json::object();
  DrawAll(AllKeys(), {fixed_.seed, clip}, values, draws);
  Config config = fixed_;
  Fill(values, config);
  for (size_t i = 0; i < config.objects.size(); ++i) {
    ObjectParams& object = config.objects[i];
    const std::string path = "objects." + std::to_string(i) + ".present";
    object.present = sim::DrawUnit({fixed_.seed, clip}, path) < object.chance;
    if (object.chance > 0 && object.chance < 1) draws[path] = object.present;
  }
  if (drawn) *drawn = std::move(draws);
  return config;
}

std::string ConfigFile::Hash() const {
  Json hashed = resolved_;
  hashed.erase(KeyOf(DefaultConfig().clips).name());
  const std::string text = CanonicalText(hashed);
  return dataset::Sha256Hex({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace shimmer::app
