// Tiny networks whose flow is known, made by networks.py with Debian's PyTorch.
#pragma once

#include <cstdlib>
#include <string>

#include "tests/app/python.h"
#include "tests/dataset/temp_folder.h"

namespace shimmer::restore {

class Networks {
 public:
  // False where there is no PyTorch to make them with.
  static bool CanBeMade() { return shimmer::app::PythonHas("torch"); }

  Networks() {
    const std::string command = std::string(shimmer::app::kPython) +
                                " -B '" SHIMMER_SOURCE_DIR "/tests/restore/torch/networks.py' '" +
                                folder_.path().string() + "'";
    if (std::system(command.c_str()) != 0) throw std::runtime_error(command);
  }

  // Of networks.py's class, or of what it writes without one.
  std::filesystem::path operator[](const std::string& name) const { return folder_ / (name + ".pt"); }

 private:
  dataset::TempFolder folder_;
};

inline constexpr const char* kNoPyTorch = "no python3-torch: scripts/setup.sh --all";

}  // namespace shimmer::restore
