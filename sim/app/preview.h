// shimmer preview DIR --out sheet.png | clip.gif
#pragma once

#include <cstdint>
#include <filesystem>

namespace shimmer::app {

struct PreviewOptions {
  std::filesystem::path folder, out;
  int64_t clip = -1;  // of the animation; -1: the first that is done
  int rows = 8;       // of the sheet, spread over the data set
};

// Draws a contact sheet (clean, turbulent, tilt as colours, sigma as heat) or an animation of one clip. Truth
// that was not written is computed again from the config. Throws std::invalid_argument for another extension
// or a clip that is not there, std::runtime_error where a file can't be read or written.
void Preview(const PreviewOptions& options);

}  // namespace shimmer::app
