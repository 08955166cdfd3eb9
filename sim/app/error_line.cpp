#include "sim/app/error_line.h"

#include <algorithm>
#include <cstdio>

namespace shimmer::app {

void PrintError(const std::string& message) {
  std::string line = message;
  // Other control characters would be commands to a terminal.
  std::ranges::replace(line, '\n', ' ');
  std::ranges::replace_if(
      line, [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  std::fprintf(stderr, "shimmer: %s\n", line.c_str());
}

}  // namespace shimmer::app
