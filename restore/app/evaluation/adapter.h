// What is where in a data set that others made, as a JSON file says it (docs/evaluation.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace shimmer::restore::app {

// A place of a clip's files below the data set's folder, in which {clip} stands for the clip's name: a folder
// of frames, a picture, a video, or names with one %d or %06d.
struct AdapterPath {
  std::string text;

  bool empty() const { return text.empty(); }
  std::filesystem::path Of(const std::string& clip) const;
};

struct Adapter {
  std::string name, about = {};
  AdapterPath turb;                   // must be there
  AdapterPath clean = {}, mask = {};  // one of them must be
  AdapterPath warp = {};              // .npy files, rows x columns x 2: dx, dy of the tilt in px
  int64_t frames = 0;                 // the first so many of a clip; 0: all
  int margin_px = 0;                  // along each side, that do not count
  nlohmann::json json = {};           // as it was read

  // Clips by name, from what there is in the folder: what stands for {clip} in turb. Without {clip} there is
  // one, of the adapter's name.
  std::vector<std::string> ClipsIn(const std::filesystem::path& folder) const;
};

// Throws std::invalid_argument "FILE: KEY: what is wrong".
Adapter ReadAdapter(const std::filesystem::path& file);

}  // namespace shimmer::restore::app
