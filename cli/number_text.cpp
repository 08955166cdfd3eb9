#include "cli/number_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

namespace shimmer::cli {

std::string RoundedText(double value, double step) {
  const double decimals = std::max(0.0, 1 - std::floor(std::log10(step)));
  char buffer[40];
  if (decimals > 9 || std::abs(value) >= 1e9) {
    std::snprintf(buffer, sizeof buffer, "%.4g", value);
    return buffer;
  }
  std::snprintf(buffer, sizeof buffer, "%.*f", static_cast<int>(decimals), value);
  std::string text = buffer;
  if (decimals > 0) text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string ShortText(double value) { return value == 0 ? "0" : RoundedText(value, std::abs(value) / 10); }

std::string Grouped(int64_t count) {
  std::string text = std::to_string(count);
  for (size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
  return text;
}

std::string Counted(int64_t count, const std::string& what) {
  return Grouped(count) + " " + what + (count == 1 ? "" : "s");
}

std::string BytesText(uint64_t bytes) {
  constexpr const char* kUnits[] = {"bytes", "kB", "MB", "GB", "TB", "PB"};
  double number = static_cast<double>(bytes);
  size_t unit = 0;
  for (; number >= 999.5 && unit + 1 < std::size(kUnits); number /= 1000) ++unit;
  return ShortText(number) + " " + kUnits[unit];
}

}  // namespace shimmer::cli
