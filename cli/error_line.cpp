#include "cli/error_line.h"

#include <algorithm>
#include <cstdio>

namespace shimmer::cli {

void PrintError(const std::string& program, const std::string& message) {
  std::string line = message;
  // Other control characters would be commands to a terminal.
  std::ranges::replace(line, '\n', ' ');
  std::ranges::replace_if(
      line, [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  std::fprintf(stderr, "%s: %s\n", program.c_str(), line.c_str());
}

}  // namespace shimmer::cli
