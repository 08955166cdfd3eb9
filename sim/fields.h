// How parameter structs declare their fields: once, in a list that drives checks, JSON, schema, help and
// records.
//
// A struct P has a static member function template
//
//   template <class Self, class Visitor> static void Fields(Self& self, Visitor& visit) {
//     visit(Field{.name = "strength_px", .unit = "px", .low = 0, .high = 64, .help = "..."},
//     self.strength_px);
//   }
//
// where Self is P or const P. A default is what the struct itself holds when new; it is written nowhere else.
#pragma once

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace shimmer::sim {

struct Field {
  const char* name;       // JSON key
  const char* unit = "";  // "px", "frames", "cycles/px"; empty for a bare number
  double low = -std::numeric_limits<double>::infinity();  // range of a number, both ends included,
  double high = std::numeric_limits<double>::infinity();  // or of the length of a list or text
  std::vector<const char*> names = {};                    // what an enum may be, in the order of its values
  std::vector<double> values = {};  // the only values that a number may take; empty: any in the range
  const char* help;
  bool per_clip = true;      // false: one value for the whole data set, no distribution
  bool alternative = false;  // exactly one of a struct's alternatives is given; an empty one is absent
};

// The shortest text that reads back as the same number: "0.1", "64", "1e-06".
template <class Number>
std::string NumberText(Number value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// "in [0, 64] px", "0.5 or 0.6"
template <class Number = double>
std::string Allowed(const Field& field) {
  const auto end = [](double bound) {
    using Limits = std::numeric_limits<Number>;
    if constexpr (std::integral<Number>) {  // the ends of 64-bit types are no doubles
      if (bound <= static_cast<double>(Limits::min())) return NumberText(Limits::min());
      if (bound >= static_cast<double>(Limits::max())) return NumberText(Limits::max());
    }
    return NumberText(static_cast<Number>(bound));
  };
  std::string text;
  if (field.values.empty()) text = "in [" + end(field.low) + ", " + end(field.high) + "]";
  for (const double value : field.values) text += (text.empty() ? "" : " or ") + NumberText(value);
  return *field.unit ? text + " " + field.unit : text;
}

// "tilt.strength_px = -3, must be in [0, 64] px"
template <class Number>
std::string OutOfRange(const std::string& path, Number value, const Field& field) {
  return path + " = " + NumberText(value) + ", must be " + Allowed<Number>(field);
}

template <class Number>
bool InRange(Number value, const Field& field) {  // false for NaN
  const double number = static_cast<double>(value);
  const bool listed = field.values.empty() ||
                      std::find(field.values.begin(), field.values.end(), number) != field.values.end();
  return number >= field.low && number <= field.high && listed;
}

// Checks every number of a struct against its declared range: the Validate() of parameter structs.
// Throws std::invalid_argument.
class RangeCheck {
 public:
  explicit RangeCheck(std::string section) : section_(std::move(section)) {}

  template <class Value>
  void operator()(const Field& field, const Value& value) const {
    if constexpr (std::is_arithmetic_v<Value> && !std::same_as<Value, bool>) {
      if (!InRange(value, field))
        throw std::invalid_argument(OutOfRange(section_ + "." + field.name, value, field));
    }
  }

 private:
  std::string section_;
};

}  // namespace shimmer::sim
