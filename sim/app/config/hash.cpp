#include "sim/app/config/hash.h"

#include <charconv>
#include <cstdlib>

namespace shimmer::app {
namespace {

// Shortest digits, as a decimal fraction from 1e-4 up to 1e16 and with an exponent beyond.
// (The JSON library's own digits are not always the shortest.)
std::string RealText(double number) {
  char text[32];
  char* end = std::to_chars(text, text + sizeof text, number, std::chars_format::scientific).ptr;
  const std::string scientific(text, end);
  const int exponent = std::atoi(scientific.c_str() + scientific.find('e') + 1);
  if (exponent < -4 || exponent >= 16) return scientific;
  end = std::to_chars(text, text + sizeof text, number, std::chars_format::fixed).ptr;
  const std::string fixed(text, end);
  return fixed.find('.') == std::string::npos ? fixed + ".0" : fixed;
}

}  // namespace

std::string CanonicalText(const Json& value) {
  if (value.is_number_float()) return RealText(value.get<double>());
  if (!value.is_structured()) return value.dump(-1, ' ', true);
  std::string text;
  for (const auto& [key, element] : value.items()) {  // an object's keys come sorted
    if (!text.empty()) text += ',';
    if (value.is_object()) text += Json(key).dump(-1, ' ', true) + ':';
    text += CanonicalText(element);
  }
  return value.is_object() ? '{' + text + '}' : '[' + text + ']';
}

}  // namespace shimmer::app
