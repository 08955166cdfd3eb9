#include "restore/app/evaluation/pictures.h"

#include <algorithm>

namespace shimmer::restore::app {

std::filesystem::path PicturesOf(const std::filesystem::path& report, const std::string& clip) {
  std::string name = clip;
  std::ranges::replace(name, '/', '_');
  // Neither the folder itself nor the one above.
  if (name.empty() || name.front() == '.') name.insert(0, "_");
  return report / kPicturesFolder / name;
}

}  // namespace shimmer::restore::app
