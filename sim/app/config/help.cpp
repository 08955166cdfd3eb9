#include <algorithm>

#include "sim/app/config/config.h"
#include "sim/app/config/distribution.h"
#include "sim/app/config/keys.h"
#include "sim/app/config/value.h"

namespace shimmer::app {
namespace {

constexpr size_t kNameColumns = 26;
constexpr size_t kDefaultColumns = 14;
constexpr size_t kExampleColumns = 44;

std::string Padded(const std::string& text, size_t columns) {
  return text + std::string(text.size() < columns ? columns - text.size() : 1, ' ');
}

// In lines of at most 112 columns, each after the indent.
std::string Wrapped(const std::string& text, const std::string& indent) {
  constexpr size_t kColumns = 112;
  std::string lines, line = indent;
  for (size_t start = 0; start < text.size();) {
    const size_t end = std::min(text.find(' ', start), text.size());
    const std::string word = text.substr(start, end - start);
    if (line.size() > indent.size() && line.size() + 1 + word.size() > kColumns) {
      lines += line + "\n";
      line = indent;
    }
    line += (line.size() > indent.size() ? " " : "") + word;
    start = end + 1;
  }
  return lines + line + "\n";
}

std::string KeysOf(const Key& section, const std::string& indent) {
  std::string text;
  bool after_section = false;
  for (const Key& key : section.keys) {
    const bool is_section = key.kind == Kind::kSection || key.kind == Kind::kList;
    if (is_section || after_section) text += "\n";
    after_section = is_section;
    if (is_section) {
      const std::string list = key.kind == Kind::kList ? " (a list: objects.0, objects.1, ...)" : "";
      text += indent + key.path + ": " + key.field.help + list + "\n" + KeysOf(key, indent + "  ");
      continue;
    }
    const std::string mark = key.field.per_clip ? "*" : "";
    const std::string fallback = key.field.alternative ? "-" : Shown(key.fallback);
    text += indent + Padded(key.path + mark, kNameColumns) + Padded(fallback, kDefaultColumns) + Wanted(key) +
            "\n";
    text += Wrapped(key.field.help, indent + "    ");
  }
  return text;
}

}  // namespace

std::string KeysHelpText() {
  std::string text = "A config is one JSON object. Each key, its default, and what it may be:\n\n";
  text += KeysOf(AllKeys(), "");
  text += "\nA key marked * has one value for all clips, or a distribution that is drawn for each clip:\n";
  for (const DistributionForm& form : kDistributionForms)
    text += Padded("  " + std::string(form.example), kExampleColumns) + form.help + "\n";
  text +=
      "With \"as\": \"LABEL\" beside it, it is drawn alike wherever that label stands (weak tilt with weak "
      "blur).\n";
  text += "A key of anything but a range of numbers takes choice alone.\n";
  return text;
}

}  // namespace shimmer::app
