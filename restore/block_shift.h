// The shift of a whole frame from the shifts of its blocks, by robust least squares.
//
// Turbulence moves each part of a frame by itself. Its mean over the frame is what can't be told from a
// shake, and it is smallest if all parts count alike, however much texture they have: so each block of
// kBlock_px squared is measured for itself (least squares on the gradient: Lucas & Kanade 1981) and weighs 1
// / (its own noise + the scatter that turbulence gives the blocks). What moves otherwise than most, such as
// an object, falls out by Tukey's biweight, and a block that does not look like the reference at all is not
// asked.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::restore {

inline constexpr int kBlock_px = 8;

// A block along one of the two axes in which its texture is strongest and weakest.
struct BlockShift {
  cv::Point2f axis;  // of length 1
  double shift_px;   // along it
  double noise_px2;  // variance by what the shift does not explain
  cv::Point at;      // of the block, px of the frame
  bool textured;     // along any axis
};

struct FrameBlocks {
  cv::Size frame;
  std::vector<BlockShift> shifts;  // one or two a block, blocks one after the other
  int textured = 0;                // blocks with texture, whether or not they gave a shift
};

// By how much `frame` has still to be moved, frame(p + shift) = reference(p), block by block. frame,
// reference and seen are CV_32FC1 of one size; pixels where seen or a neighbour's is 0 are left out, and so
// is a rim of Mosaic::kRim_px of the frame. Shifts are good to a px or two. Blocks without texture, or that
// correlate with the reference by less than 0.5, give none.
FrameBlocks BlockShifts(const cv::Mat& frame, const cv::Mat& reference, const cv::Mat& seen);

struct CommonShift {
  cv::Point2d shift_px;   // NaN where it isn't determined along both axes
  double scatter_px = 0;  // of the blocks around it along an axis, standard deviation: turbulence
  double error_px = 0;    // what |shift_px - truth| stays within, mostly
  double agreeing = 0;    // part of the blocks with texture, in [0, 1], that the biweight leaves a weight
};
CommonShift CommonShiftOf(const FrameBlocks& blocks);

}  // namespace shimmer::restore
