#include "sim/app/config/keys.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace shimmer::app {
namespace {

using Points = std::vector<cv::Point2d>;

template <class Value>
constexpr bool kIsEnum = std::is_enum_v<Value>;
template <class Value>
constexpr bool kIsInteger = std::integral<Value> && !std::same_as<Value, bool>;

template <class Value>
Kind KindOf(const Field& field) {
  if constexpr (std::same_as<Value, double>) return Kind::kReal;
  if constexpr (kIsInteger<Value>) return Kind::kInteger;
  if constexpr (std::same_as<Value, bool>) return Kind::kFlag;
  if constexpr (kIsEnum<Value>) return Kind::kName;
  if constexpr (std::same_as<Value, std::string>) return field.names.empty() ? Kind::kText : Kind::kName;
  if constexpr (std::same_as<Value, std::vector<std::string>>) return Kind::kTexts;
  if constexpr (std::same_as<Value, cv::Size>) return Kind::kSize;
  if constexpr (std::same_as<Value, Points>) return Kind::kPoints;
}

// What the ends of a field's range are numbers of: sizes and lengths are whole.
template <class Value>
using RangeNumber = std::conditional_t<kIsInteger<Value> || std::same_as<Value, double>, Value,
                                       std::conditional_t<std::same_as<Value, Points>, double, int>>;

// An end of a range; null for infinity. Whole numbers end at the ends of their type at the latest.
template <class Value>
Json RangeEnd(double end) {
  using Limits = std::numeric_limits<RangeNumber<Value>>;
  if constexpr (kIsInteger<Value>) {
    if (end >= static_cast<double>(Limits::max())) return Limits::max();
    if (end <= static_cast<double>(Limits::min())) return Limits::min();
  }
  if (std::isinf(end)) return nullptr;
  return static_cast<RangeNumber<Value>>(end);
}

template <class Value>
Json ToJson(const Value& value, const Field& field) {
  if constexpr (kIsEnum<Value>)
    return field.names.at(static_cast<size_t>(value));
  else if constexpr (std::same_as<Value, cv::Size>)
    return Json::array({value.width, value.height});
  else if constexpr (std::same_as<Value, Points>) {
    Json points = Json::array();
    for (const cv::Point2d& point : value) points.push_back({point.x, point.y});
    return points;
  } else
    return value;
}

template <class Value>
void FromJson(const Json& json, const Field& field, Value& value) {
  if constexpr (kIsEnum<Value>) {
    const auto& name = json.get_ref<const std::string&>();
    value = static_cast<Value>(std::find(field.names.begin(), field.names.end(), name) - field.names.begin());
  } else if constexpr (std::same_as<Value, cv::Size>) {
    value = {json.at(0).get<int>(), json.at(1).get<int>()};
  } else if constexpr (std::same_as<Value, Points>) {
    value.clear();
    for (const Json& point : json) value.emplace_back(point.at(0).get<double>(), point.at(1).get<double>());
  } else {
    json.get_to(value);
  }
}

class KeyLister {
 public:
  explicit KeyLister(Key& section) : section_(section) {}

  template <class Value>
  void operator()(const Field& field, const Value& value) {
    if (std::same_as<Value, uint64_t> && field.per_clip)
      throw std::logic_error(std::string(field.name) + ": draws are signed; say .per_clip = false");
    Key& key = Add(field, KindOf<Value>(field));
    key.member = &value;
    key.low = RangeEnd<Value>(field.low);
    key.high = RangeEnd<Value>(field.high);
    key.allowed = sim::Allowed<RangeNumber<Value>>(field);
    if (!field.alternative) key.fallback = ToJson(value, field);
  }

  template <class Struct>
  void Section(const char* name, const char* help, const Struct& part) {
    KeyLister lister(Add({.name = name, .help = help}, Kind::kSection));
    Struct::Fields(part, lister);
  }

  // As many as the config lists, at most `most`; each has its defaults.
  template <class Struct>
  void List(const char* name, double most, const char* help, const std::vector<Struct>&) {
    static const Struct element;
    Key& list = Add({.name = name, .low = 0, .high = most, .help = help, .per_clip = false}, Kind::kList);
    list.fallback = Json::array();
    list.low = 0, list.high = static_cast<int>(most);
    KeyLister lister(list);
    Struct::Fields(element, lister);
  }

 private:
  Key& Add(const Field& field, Kind kind) {
    const std::string name = field.name;
    return section_.keys.emplace_back(Key{.path = section_.path.empty() ? name : section_.path + "." + name,
                                          .pointer = PointerUnder(section_.pointer, name),
                                          .field = field,
                                          .kind = kind});
  }

  Key& section_;
};

class Filler {
 public:
  explicit Filler(const Json& values) : values_(values) {}

  template <class Value>
  void operator()(const Field& field, Value& value) const {
    const auto found = values_.find(field.name);
    if (found != values_.end() && !found->is_object()) FromJson(*found, field, value);
  }

  template <class Struct>
  void Section(const char* name, const char*, Struct& part) const {
    const Filler filler(values_.at(name));
    Struct::Fields(part, filler);
  }

  template <class Struct>
  void List(const char* name, double, const char*, std::vector<Struct>& list) const {
    const Json& values = values_.at(name);
    list.resize(values.size());
    for (size_t i = 0; i < list.size(); ++i) {
      const Filler filler(values[i]);
      Struct::Fields(list[i], filler);
    }
  }

 private:
  const Json& values_;
};

const Key* Find(const Key& section, const auto& wanted) {
  for (const Key& key : section.keys) {
    if (wanted(key)) return &key;
    if (const Key* found = Find(key, wanted)) return found;
  }
  return nullptr;
}

}  // namespace

const Config& DefaultConfig() {
  static const Config config;
  return config;
}

const Key& AllKeys() {
  static const Key all = [] {
    Key root{.path = "",
             .pointer = "",
             .field = {.name = "", .help = "Shimmer config: one data set of turbulent clips"},
             .kind = Kind::kSection};
    KeyLister lister(root);
    Config::Fields(DefaultConfig(), lister);
    return root;
  }();
  return all;
}

const Key& KeyAt(const void* member) {
  const Key* key = Find(AllKeys(), [&](const Key& k) { return k.member == member; });
  if (!key) throw std::invalid_argument("KeyAt: not a member of DefaultConfig() that Fields lists");
  return *key;
}

namespace {

void MoveKeys(std::vector<Key>& keys, const Key& from, const Key& to) {
  for (Key& key : keys) {
    key.path = to.path + key.path.substr(from.path.size());
    key.pointer = to.pointer + key.pointer.substr(from.pointer.size());
    MoveKeys(key.keys, from, to);
  }
}

}  // namespace

Key ElementOf(const Key& list, size_t index) {
  Key element = list;
  element.kind = Kind::kSection;
  element.path += "." + std::to_string(index);
  element.pointer += "/" + std::to_string(index);
  MoveKeys(element.keys, list, element);
  return element;
}

std::vector<std::string> KeyNames(const Key& section) {
  std::vector<std::string> names;
  for (const Key& key : section.keys) names.push_back(key.name());
  return names;
}

ConfigError NoSuchKey(const Key& section, const std::string& name) {
  const std::string pointer = PointerUnder(section.pointer, name);
  const std::vector<std::string> names = KeyNames(section);
  const Key* elsewhere = Find(AllKeys(), [&](const Key& key) { return key.name() == name; });
  if (elsewhere && Closest(name, names).empty())
    return {pointer, "unknown key '" + name + "'; did you mean '" + elsewhere->path + "'" +
                         (elsewhere->path == name ? " of the config itself?" : "?")};
  return {pointer, UnknownKey(name, names)};
}

void Fill(const Json& resolved, Config& config) {
  const Filler filler(resolved);
  Config::Fields(config, filler);
}

}  // namespace shimmer::app
