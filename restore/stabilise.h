// By how much a camera shook: a translation a frame, from the frames alone.
//
// Signs, as in a clip's truth: steady(p) = shaken(p + s), s = (0, 0) in the first frame. What lies at p in
// the steady frame is seen at p + s.
//
// Each frame's detail is compared with the mean of all earlier ones (mosaic.h): by zero-mean normalised
// cross-correlation at all shifts, then block by block to a part of a px (block_shift.h). Only the mean of
// the turbulence over the frame, less that over the first, can't be told from a shake.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <span>

namespace shimmer::restore {

enum class Match {
  kFound,
  kFlat,  // nothing is to be seen in the frame: black, or of one colour
  kLost,  // the frame shows something else than those before, or is further off than max_shift_px
};

struct FrameShift {
  cv::Point2d px;  // s; where the match is not kFound that of the frame before, (0, 0) in the first
  Match match = Match::kFound;
  double correlation = 0;  // of the frame's detail with the mean of those before, in [-1, 1]; 1 in the first
  double clearness = 0;    // how many standard deviations the match stands above those at all shifts
  double scatter_px = 0;   // of blocks of the frame around s, along an axis: turbulence; 0 in the first
  double error_px = 0;     // standard deviation of s by that scatter; 0 in the first
};

struct StabiliseParams {
  // The most |s| along each axis. 0: 400 px at 1080p, and as much of the shorter side for other sizes.
  double max_shift_px = 0;
};

// Frames one after the other, in the memory of two small levels of a frame, however many there are.
class Stabiliser {
 public:
  // Throws std::invalid_argument if max_shift_px is negative or not finite.
  explicit Stabiliser(StabiliseParams params = {});
  ~Stabiliser();
  Stabiliser(Stabiliser&&) noexcept;
  Stabiliser& operator=(Stabiliser&&) noexcept;

  // frame: CV_8U, CV_16U or CV_32F of 1, 3 or 4 channels in any order (alpha last), 16x16 px or more, of the
  // size and type of the first; else throws std::invalid_argument. The same on any number of threads.
  FrameShift Next(const cv::Mat& frame);

 private:
  struct Levels;
  StabiliseParams params_;
  std::unique_ptr<Levels> levels_;
  cv::Point2d last_px_;
};

// Whether the camera stood, so that moving frames would gain nothing and cost sharpness.
bool IsSteady(std::span<const FrameShift> shifts);

// What is on all frames of that size, in px of the steady frame: a crop to it shows no border. Empty if
// there is no such px.
cv::Rect CommonArea(std::span<const FrameShift> shifts, cv::Size size);

}  // namespace shimmer::restore
