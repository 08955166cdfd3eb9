// By how much a camera shook: a translation a frame, from the frames alone.
//
// Signs, as in a clip's truth: steady(p) = shaken(p + s), s = (0, 0) in the first frame. What lies at p in
// the steady frame is seen at p + s.
//
// Each frame's detail is compared with the mean of all others so far (mosaic.h): by zero-mean normalised
// cross-correlation at all shifts, then block by block to a part of a px (block_shift.h). The first frames
// are then aligned together, before any shift is given out. Only the mean of the turbulence over a frame,
// less that over the first, can't be told from a shake.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

namespace shimmer::restore {

enum class Match {
  kFound,
  kFlat,  // too little is to be seen in the frame: black, of one colour, or coarse alone, as in the last
          // found
  kLost,  // the frame shows something else than those before, or is further off than max_shift_px
};

struct FrameShift {
  cv::Point2d px = {};          // s; where the match is not kFound, that of the frame before
  Match match = Match::kFound;  // the rest is of kFound and kLost alone
  double correlation =
      0;                 // of the frame's detail with the others' mean, in [-1, 1]; 1 where there is no other
  double clearness = 0;  // its score, in standard deviations of those by chance; 0 in the first frame
  double scatter_px = 0;  // of blocks of the frame around s, along an axis, standard deviation: turbulence
  // What |s - truth| stays within: of 309 in 310 held-out frames of 1080p under strong turbulence, of 3 in 4
  // of 320x240 under as many px of it, where the air's mean is too large to be told from its differences. The
  // first frame's own air is in it; 0 in the first frame. Not where s is an object's: that is what unsure is
  // for.
  double error_px = 0;
  double agreeing = 0;  // part of what has texture that moves with s, in [0, 1]
  bool unsure = false;  // kFound, but much moves otherwise: s may be that of a large object
};

struct StabiliseParams {
  // The most |s| along each axis. 0: 400 px at 1080p, and as much of the shorter side for other sizes.
  double max_shift_px = 0;
  int first_frames = 24;  // that are aligned together; at least 1
};

// Frames one after the other, in the memory of first_frames small levels of a frame, however many there are.
class Stabiliser {
 public:
  // Throws std::invalid_argument for params outside of their ranges.
  explicit Stabiliser(StabiliseParams params = {});
  ~Stabiliser();
  Stabiliser(Stabiliser&&) noexcept;
  Stabiliser& operator=(Stabiliser&&) noexcept;

  // The shifts that are known now, in order: none for the first first_frames - 1 frames, then those of all of
  // them, then one a frame. frame: CV_8U, CV_16U or CV_32F of 1, 3 or 4 channels in any order (alpha last),
  // 16x16 px or more, of the size and type of the first; else throws std::invalid_argument. The same on any
  // number of threads.
  std::vector<FrameShift> Next(const cv::Mat& frame);

  // After the last frame: the shifts that are still to come, if there were fewer than first_frames.
  std::vector<FrameShift> Rest();

 private:
  struct State;
  StabiliseParams params_;
  std::unique_ptr<State> state_;
};

// Whether the camera stood: no s is half a px or more along an axis. To move such frames would move none of
// them by a px, and cost them sharpness.
bool IsSteady(std::span<const FrameShift> shifts);

// Whether at least half of the frames that show anything were found: else they are of no one scene, since the
// camera goes too far, or everything moves.
bool AreOfOneScene(std::span<const FrameShift> shifts);

// The first of the frames at the end of which none shows what those before show: 8 or more, and 8 or more
// that were found before. Nothing where there is no such cut.
std::optional<size_t> LastingCut(std::span<const FrameShift> shifts);

// What is on all frames of that size, in px of the steady frame: a crop to it shows no border. Empty if
// there is no such px.
cv::Rect CommonArea(std::span<const FrameShift> shifts, cv::Size size);

}  // namespace shimmer::restore
