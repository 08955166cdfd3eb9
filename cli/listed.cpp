#include "cli/listed.h"

namespace shimmer::cli {

std::string Listed(std::span<const std::string> names, const std::string& joint) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 < names.size() ? ", " : " " + joint + " ";
    text += "'" + names[i] + "'";
  }
  return text;
}

}  // namespace shimmer::cli
