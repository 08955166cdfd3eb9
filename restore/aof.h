// How frames move against their neighbours: the paper's averaged optical flow (AOF: what moves on, moves far
// to most neighbours; what turbulence moves, does not), and the speed of what moves on steadily.
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "restore/border_fill.h"
#include "restore/flow.h"

namespace shimmer::restore {

// Neighbours of a frame: those 2, 4 and 8 before and after it, the nearest N of them: 2, 4 or 6.
inline constexpr int kMostNeighbours = 6, kReach = 8;
// The distance in time of neighbour n, of 0 to 5: -2, 2, -4, 4, -8, 8.
int NeighbourAt(int n);
// How far the nearest N are on average: what goes on by v px a frame has an AOF of v times it.
double MeanDistance(int neighbours);

struct AofSettings {
  int neighbours = 4;       // N: 2, 4 or 6
  double threshold_px = 0;  // moving: what has a larger AOF. 0: nothing is seen to move
  double typical_px = 0;    // the median of all AOF: of turbulence, unless most of the video moves
};

// A frame of a sequence with what is there of its neighbours.
struct Place {
  SteadyFrame current;
  std::vector<SteadyFrame> neighbours;  // as NeighbourAt counts; empty frames where there is none
};

// The place of frame k; frame_at(i) is nullptr where there is no frame i.
Place PlaceAt(int64_t k, const std::function<const SteadyFrame*(int64_t)>& frame_at);
// The same in a row of frames.
Place PlaceAt(int64_t k, const std::vector<SteadyFrame>& frames);

// SteadyFrame::own at another size.
cv::Mat OwnAtSize(const cv::Mat& own, cv::Size size);

// How far the frame's pixels are from where they are in each neighbour, in px, for N = 2, 4 and 6: of the
// same number of flows as N = 6 alone. CV_32FC1 of HalvedIfLarge's size, in px of that; 0 where the frame is
// filled, or it or all its neighbours have no texture to tell by. A neighbour that is not there, or is
// filled at that px, is left out of the mean.
std::vector<cv::Mat> AofOf(DenseFlow& flow, const Place& place, int most_neighbours = kMostNeighbours);

// Both of the same flows.
struct Motion {
  std::vector<cv::Mat> aof;
  // In px of the reduced frame a frame: of the line that fits the displacements over time best, the frame
  // itself at 0. What turbulence does to and fro hardly tilts that line: of tilts that are independent from
  // frame to frame it leaves 1/13 with all neighbours, where AOF keeps all. CV_32FC1, else as AOF.
  cv::Mat speed;
};
Motion MotionOf(DenseFlow& flow, const Place& place, int most_neighbours = kMostNeighbours);

// How clearly an AOF parts what moves from what does not, as the paper has it: the mean of |a - 0.5|, a the
// AOF divided by its largest value, over px with use != 0. In [0, 0.5]; 0 where nothing moves or is used.
double Clearness(const cv::Mat& aof, const cv::Mat& use);

// Collects places of a video, evenly spread, and settles N (the clearest on average) and the threshold:
// Otsu's of all AOF with that N, divided by 1.5 as the paper's authors do.
class AofChoice {
 public:
  // AOF of a place, for its N of 2, 4 and 6, and where the frame is its own.
  void Add(const std::vector<cv::Mat>& aof, const cv::Mat& own);
  AofSettings Settings() const;

 private:
  struct Seen {
    std::vector<cv::Mat> aof;
    cv::Mat own;
  };
  std::vector<Seen> seen_;
};

}  // namespace shimmer::restore
