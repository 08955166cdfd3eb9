#include "sim/dataset/pattern_list.h"

#include <cctype>
#include <sstream>
#include <stdexcept>

#include "sim/dataset/files.h"

namespace shimmer::dataset {
namespace {

std::string WithoutBlanksAround(const std::string& line) {
  constexpr const char* kBlanks = " \t\r";
  const size_t first = line.find_first_not_of(kBlanks);
  return first == std::string::npos ? "" : line.substr(first, line.find_last_not_of(kBlanks) + 1 - first);
}

}  // namespace

bool NamesList(const std::string& pattern) {
  std::string extension = std::filesystem::path(pattern).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".txt";
}

std::vector<ListedPattern> ReadPatternList(const std::filesystem::path& list) {
  const std::vector<uint8_t> bytes = ReadFile(list);
  std::string text(bytes.begin(), bytes.end());
  // Windows marks UTF-8 so, and nothing of it is to be seen in an editor.
  if (constexpr const char* kMark = "\xEF\xBB\xBF"; text.starts_with(kMark)) text.erase(0, 3);
  // The system would take a pattern to end at a zero, and find something else.
  if (text.find('\0') != std::string::npos)
    throw std::runtime_error(list.string() + ": not a text, must be one in UTF-8 with one pattern a line");
  std::vector<ListedPattern> patterns;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string pattern = WithoutBlanksAround(line);
    if (pattern.empty() || pattern.starts_with('#')) continue;
    if (NamesList(pattern))
      throw std::runtime_error(list.string() + ":" + std::to_string(number) + ": '" + pattern +
                               "': lists don't nest, must be a file, a folder or a pattern");
    patterns.push_back({pattern, number});
  }
  if (patterns.empty())
    throw std::runtime_error(list.string() +
                             ": no pattern in it, must have one a line (a line that starts with # is none)");
  return patterns;
}

}  // namespace shimmer::dataset
