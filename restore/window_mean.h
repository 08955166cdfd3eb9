// The mean over time of a piece of a row of px: the inner loop of the background (background.h).
#pragma once

#include <cstdint>
#include <vector>

namespace shimmer::restore {

inline constexpr int kPiece_px = 128;  // of a row, at most; its sums stay in the first cache

// One frame of the window at one piece of a row.
struct Part {
  const uint8_t* row;     // samples, of the frames' type
  const uint8_t* weight;  // nullptr: all 255
  const uint8_t* luck;    // LuckOf the frame; nullptr in all parts: all are as lucky
  float gaussian;
};

// What is known before, at that piece; nullptr if nothing is.
struct Before {
  const uint8_t *row, *seen;
};

// Of parts (one at least) the mean of a piece of px, and where it is seen (255, else 0): samples times
// gaussian, weight and luck over the sum of these. What the parts show of a px counts whole, however lucky it
// is; where that is less than a quarter of what they could show, the rest is taken from before, or is what
// hides the px.
using MeanOfPiece = void (*)(const std::vector<Part>& parts, const Before& before, int px, uint8_t* to,
                             uint8_t* seen);

// For frames of CV_8U, CV_16U or CV_32F, of 1 or 3 channels.
MeanOfPiece MeanOfType(int type);

}  // namespace shimmer::restore
