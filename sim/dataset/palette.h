// 256 colours for an animation: one palette for all its frames and a fixed dither pattern, so that what
// stands still in the frames stands still in the file. (A palette a frame flickers, which in a clip looks
// like turbulence.)
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

namespace shimmer::dataset {

using Palette = std::array<cv::Vec3b, 256>;  // RGB

// Chosen for the colours in frames (CV_8UC3): cut at the mean where the squared error is largest, then
// settled.
Palette ChoosePalette(std::span<const cv::Mat> frames);

// A frame's pixels as places in the palette, row by row.
class PaletteMapper {
 public:
  explicit PaletteMapper(const Palette& palette);
  std::vector<uint8_t> Map(const cv::Mat& frame);

 private:
  uint8_t Nearest(int red, int green, int blue);

  Palette palette_;
  std::vector<int16_t> nearest_;  // by colour at 7 bits a channel; -1 where nobody asked yet
};

}  // namespace shimmer::dataset
