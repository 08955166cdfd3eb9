// File names with a frame number in them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shimmer::dataset {

// "000123": the number with zeros in front, to at least so many digits.
std::string Padded(int64_t number, size_t digits);

// "in%06d.jpg": text, a number with at least that many digits, text.
struct NumberedName {
  std::string before;
  size_t digits = 1;
  std::string after;

  // Nothing if there is not exactly one %d or %0Nd (N 1 to 18) in the name, or another % beside it.
  static std::optional<NumberedName> Parse(const std::string& name);

  std::string Of(int64_t number) const;
  std::optional<int64_t> NumberOf(const std::string& name) const;  // so that Of(number) is this name
};

// The numbers of the files in a folder with such names, ascending. Empty if there is no such folder.
std::vector<int64_t> NumbersIn(const std::filesystem::path& folder, const NumberedName& name);

// Order of names by the last number in them, however many digits it has; names without a number come first.
bool LastNumberLess(const std::string& a, const std::string& b);

}  // namespace shimmer::dataset
