#include "sim/app/config/error.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <vector>

#include "cli/listed.h"

namespace shimmer::app {
namespace {

constexpr size_t kMaxShownBytes = 60;

std::string CutShort(std::string text) {
  if (text.size() <= kMaxShownBytes) return text;
  size_t bytes = kMaxShownBytes;
  while (bytes > 0 && (text[bytes] & 0xC0) == 0x80) --bytes;  // not within a character
  return text.substr(0, bytes) + "...";
}

std::string Dumped(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string LowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Letters to change, add, leave out, or swap with their neighbour to make one text the other.
size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

}  // namespace

std::string Shown(const Json& value) { return CutShort(Dumped(value)); }

std::string ShownText(const std::string& text) {
  const std::string quoted = Dumped(text);
  return CutShort(quoted.substr(1, quoted.size() - 2));
}

std::string PointerUnder(const std::string& pointer, const std::string& key) {
  std::string step;
  for (const char c : ShownText(key)) {
    if (c == '~')
      step += "~0";
    else if (c == '/')
      step += "~1";
    else
      step += c;
  }
  return pointer + "/" + step;
}

std::string PointerUnder(const std::string& pointer, size_t index) {
  return pointer + "/" + std::to_string(index);
}

std::string Closest(const std::string& name, std::span<const std::string> candidates) {
  std::string best;
  size_t best_distance = std::numeric_limits<size_t>::max();
  for (const std::string& candidate : candidates) {
    const std::string without_unit = candidate.substr(0, candidate.rfind('_'));
    for (const std::string& meant : {candidate, without_unit}) {
      const size_t longer = std::max(name.size(), meant.size());
      const size_t limit =
          std::max<size_t>(1, longer / 3);  // further apart, a guess is more likely wrong than right
      if (longer - std::min(name.size(), meant.size()) > limit) continue;
      const size_t distance = EditDistance(LowerCase(name), LowerCase(meant));
      if (distance > limit || distance >= best_distance) continue;
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string UnknownKey(const std::string& name, std::span<const std::string> known) {
  const std::string closest = Closest(name, known);
  return "unknown key '" + ShownText(name) + "'; " +
         (closest.empty() ? "must be " + cli::Listed(known, "or") : "did you mean '" + closest + "'?");
}

void RequireObject(const Json& value, const std::string& pointer) {
  if (!value.is_object()) throw ConfigError(pointer, "is " + Shown(value) + ", must be an object");
}

void RequireUtf8(const std::string& text, const std::string& pointer) {
  try {
    Json(text).dump();
  } catch (const Json::type_error&) {
    throw ConfigError(pointer, "is '" + ShownText(text) + "', must be UTF-8 text");
  }
}

}  // namespace shimmer::app
