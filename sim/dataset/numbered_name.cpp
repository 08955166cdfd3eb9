#include "sim/dataset/numbered_name.h"

#include <algorithm>
#include <utility>

#include "sim/dataset/glob.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDigits = "0123456789";

// The last run of digits as (length without leading zeros, digits), which orders as the number does; length 0
// is zero.
std::optional<std::pair<size_t, std::string>> LastNumber(const std::string& text) {
  const size_t last = text.find_last_of(kDigits);
  if (last == std::string::npos) return {};
  const size_t before = text.find_last_not_of(kDigits, last);
  const size_t first = before == std::string::npos ? 0 : before + 1;
  std::string digits = text.substr(first, last + 1 - first);
  digits.erase(0, digits.find_first_not_of('0'));
  return std::pair(digits.size(), digits);
}

}  // namespace

std::string Padded(int64_t number, size_t digits) {
  std::string text = std::to_string(number);
  if (text.size() < digits) text.insert(0, digits - text.size(), '0');
  return text;
}

std::optional<NumberedName> NumberedName::Parse(const std::string& name) {
  const size_t percent = name.find('%');
  if (percent == std::string::npos || name.find('%', percent + 1) != std::string::npos) return {};
  const size_t d = name.find_first_not_of(kDigits, percent + 1);
  if (d == std::string::npos || name[d] != 'd') return {};
  NumberedName parsed{name.substr(0, percent), 1, name.substr(d + 1)};
  const std::string width = name.substr(percent + 1, d - percent - 1);
  if (width.empty()) return parsed;
  if (width[0] != '0' || width.size() < 2 || width.size() > 3) return {};
  parsed.digits = std::stoul(width);
  if (parsed.digits < 1 || parsed.digits > 18) return {};
  return parsed;
}

std::string NumberedName::Of(int64_t number) const { return before + Padded(number, digits) + after; }

std::optional<int64_t> NumberedName::NumberOf(const std::string& name) const {
  if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
    return {};
  const std::string middle = name.substr(before.size(), name.size() - before.size() - after.size());
  if (middle.size() > 18 || middle.find_first_not_of(kDigits) != std::string::npos) return {};
  const int64_t number = std::stoll(middle);
  if (Of(number) != name) return {};
  return number;
}

std::vector<int64_t> NumbersIn(const fs::path& folder, const NumberedName& name) {
  std::vector<int64_t> numbers;
  const fs::path here = folder.empty() ? fs::path(".") : folder;
  if (!fs::is_directory(here)) return numbers;
  for (const fs::path& entry : VisibleEntries(here))
    if (const auto number = name.NumberOf(entry.filename().string())) numbers.push_back(*number);
  std::ranges::sort(numbers);
  return numbers;
}

bool LastNumberLess(const std::string& a, const std::string& b) { return LastNumber(a) < LastNumber(b); }

}  // namespace shimmer::dataset
