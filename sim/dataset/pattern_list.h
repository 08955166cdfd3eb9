// Lists of source patterns: text files with one pattern a line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shimmer::dataset {

struct ListedPattern {
  std::string pattern;
  int line;  // counted from 1
};

// Whether a pattern stands for a list: its name ends in ".txt", in either case.
bool NamesList(const std::string& pattern);

// Of each line what is between the blanks at its ends, but for lines of blanks alone and those that start
// with #. Lines may end as on Windows. Throws std::runtime_error with the list's name, and the line's number
// where there is one, if it can't be read, is no text, names a list again or holds no pattern.
std::vector<ListedPattern> ReadPatternList(const std::filesystem::path& list);

}  // namespace shimmer::dataset
