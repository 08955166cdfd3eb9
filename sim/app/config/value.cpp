#include "sim/app/config/value.h"

#include <algorithm>
#include <cmath>

namespace shimmer::app {
namespace {

ConfigError Wrong(const Json& value, const std::string& pointer, const std::string& wanted) {
  return {pointer, "is " + Shown(value) + ", must be " + wanted};
}

std::string OneOfNames(const Key& key) {
  std::string text;
  for (const char* name : key.field.names) text += (text.empty() ? "one of " : ", ") + Json(name).dump();
  return text;
}

// "a whole number in [1, 16]"; of a closed list, that list: "8 or 16 or 32"
std::string NumberInWords(const Key& key, const std::string& number) {
  return key.field.values.empty() ? number + " " + key.allowed : key.allowed;
}

// " of 1 to 100 bytes"; empty where any length will do.
std::string LengthInWords(const Key& key, const std::string& unit) {
  if (key.low.is_null()) return "";
  if (key.high.is_null()) return " of at least " + key.low.dump() + " " + unit;
  return " of " + key.low.dump() + " to " + key.high.dump() + " " + unit;
}

Json CheckedReal(const Key& key, const Json& value, const std::string& pointer) {
  if (!value.is_number()) throw Wrong(value, pointer, NumberInWords(key, "a number"));
  const double number = value.get<double>() + 0.0;  // -0 becomes 0
  if (!sim::InRange(number, key.field)) throw Wrong(value, pointer, key.allowed);
  return number;
}

__int128 Exact(const Json& whole_number) {
  if (whole_number.is_number_unsigned()) return whole_number.get<uint64_t>();
  return whole_number.get<int64_t>();
}

Json CheckedInteger(const Key& key, const Json& value, const std::string& pointer) {
  if (value.is_number_float() && value.get<double>() == std::floor(value.get<double>()))
    throw Wrong(value, pointer,
                NumberInWords(key, "a whole number") + ", written without fraction or exponent");
  if (!value.is_number_integer()) throw Wrong(value, pointer, NumberInWords(key, "a whole number"));
  const __int128 number = Exact(value);  // doubles round the ends of 64-bit types
  if (number < Exact(key.low) || number > Exact(key.high) || !sim::InRange(number, key.field))
    throw Wrong(value, pointer, key.allowed);
  return value;
}

Json CheckedFlag(const Key& key, const Json& value, const std::string& pointer) {
  if (!value.is_boolean()) throw Wrong(value, pointer, Wanted(key));
  return value;
}

Json CheckedName(const Key& key, const Json& value, const std::string& pointer) {
  const auto& names = key.field.names;
  if (!value.is_string() || std::find(names.begin(), names.end(), value.get<std::string>()) == names.end())
    throw Wrong(value, pointer, OneOfNames(key));
  return value;
}

// allowed_bytes: whether a text of this length will do.
Json CheckedText(const Json& value, const std::string& pointer, const std::string& wanted,
                 const auto& allowed_bytes) {
  if (!value.is_string() || !allowed_bytes(value.get_ref<const std::string&>().size()))
    throw Wrong(value, pointer, wanted);
  if (value.get_ref<const std::string&>().find('\0') != std::string::npos)
    throw Wrong(value, pointer, "a text without NUL characters");
  return value;
}

Json CheckedTexts(const Key& key, const Json& value, const std::string& pointer) {
  const bool single = value.is_string();
  const bool named = !key.field.names.empty();
  if (!single && !value.is_array()) throw Wrong(value, pointer, Wanted(key));
  if (!single && !sim::InRange(value.size(), key.field)) throw Wrong(value, pointer, Wanted(key));
  const auto checked_element = [&](const Json& element, const std::string& here) {
    if (named) return CheckedName(key, element, here);
    return CheckedText(element, here, "a text that is not empty", [](size_t bytes) { return bytes > 0; });
  };
  if (single) return Json::array({checked_element(value, pointer)});
  Json checked = Json::array();
  for (size_t i = 0; i < value.size(); ++i) {
    const std::string here = PointerUnder(pointer, i);
    if (named && std::find(checked.begin(), checked.end(), value[i]) != checked.end())
      throw ConfigError(here, Shown(value[i]) + " is there twice; must be there once");
    checked.push_back(checked_element(value[i], here));
  }
  return checked;
}

Json CheckedSize(const Key& key, const Json& value, const std::string& pointer) {
  if (!value.is_array() || value.size() != 2) throw Wrong(value, pointer, Wanted(key));
  return Json::array({CheckedInteger(key, value[0], PointerUnder(pointer, size_t{0})),
                      CheckedInteger(key, value[1], PointerUnder(pointer, size_t{1}))});
}

Json CheckedPoints(const Key& key, const Json& value, const std::string& pointer) {
  if (!value.is_array()) throw Wrong(value, pointer, Wanted(key));
  Json checked = Json::array();
  for (size_t i = 0; i < value.size(); ++i) {
    const std::string here = PointerUnder(pointer, i);
    if (!value[i].is_array() || value[i].size() != 2)
      throw Wrong(value[i], here, "[x, y], numbers " + key.allowed);
    checked.push_back({CheckedReal(key, value[i][0], PointerUnder(here, size_t{0})),
                       CheckedReal(key, value[i][1], PointerUnder(here, size_t{1}))});
  }
  return checked;
}

}  // namespace

std::string Wanted(const Key& key) {
  switch (key.kind) {
    case Kind::kSection:
      return "an object";
    case Kind::kList:
      return "a list of at most " + key.high.dump() + " objects";
    case Kind::kPoints:
      return "a list of [x, y], numbers " + key.allowed;
    case Kind::kReal:
      return NumberInWords(key, "a number");
    case Kind::kInteger:
      return NumberInWords(key, "a whole number");
    case Kind::kFlag:
      return "true or false";
    case Kind::kName:
      return OneOfNames(key);
    case Kind::kText:
      return "a text" + LengthInWords(key, "bytes");
    case Kind::kTexts:
      if (key.field.names.empty()) return "a text or a list" + LengthInWords(key, "text");
      return "a list of texts, each " + OneOfNames(key);
    case Kind::kSize:
      return "[width, height], whole numbers " + key.allowed;
  }
  throw std::logic_error("Wanted: a kind without words");
}

Json CheckedLiteral(const Key& key, const Json& value, const std::string& pointer) {
  switch (key.kind) {
    case Kind::kSection:
    case Kind::kList:
      throw std::logic_error("CheckedLiteral: a section is no literal");
    case Kind::kPoints:
      return CheckedPoints(key, value, pointer);
    case Kind::kReal:
      return CheckedReal(key, value, pointer);
    case Kind::kInteger:
      return CheckedInteger(key, value, pointer);
    case Kind::kFlag:
      return CheckedFlag(key, value, pointer);
    case Kind::kName:
      return CheckedName(key, value, pointer);
    case Kind::kText:
      return CheckedText(value, pointer, Wanted(key),
                         [&](size_t bytes) { return sim::InRange(bytes, key.field); });
    case Kind::kTexts:
      return CheckedTexts(key, value, pointer);
    case Kind::kSize:
      return CheckedSize(key, value, pointer);
  }
  throw std::logic_error("CheckedLiteral: a kind without a check");
}

}  // namespace shimmer::app
