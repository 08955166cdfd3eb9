// How sharp a frame happens to be, px by px: air that moves blurs a scene now here, now there, and what is
// sharp is worth more in a mean over time (lucky-region fusion: Aubailly et al. 2009).
#pragma once

#include <bit>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::restore {

// Detail is the Laplacian of the luma (levels.h), softened first, which leaves little of noise; its energy
// the mean of its squares over a Gaussian, and kLuckFloor, below which frames are told apart by their noise
// alone.
inline constexpr double kLuckSoft_px = 0.8, kLuckReach_px = 1, kLuckFloor = 4;

// Eighths of an octave of the energy around each px, CV_8UC1: 8 more where it is twice as much. frame: as
// levels.h takes it; throws std::invalid_argument for another. The same on any number of threads.
cv::Mat LuckOf(const cv::Mat& frame);

// What a px counts that is `less` below the luckiest: the square of the ratio of their energies, 2^(-less /
// 4), to 6 %: 1, 7/8, 3/4, 5/8, 1/2 and so on. (The fourth power gains 0.4 dB more on clips of Shimmer's, but
// of real air with few frames it picks noise, and single_car's lines are no straighter than they came.)
inline float LuckWeight(uint32_t less) { return std::bit_cast<float>((508 - less) << 21); }

// Whether frames differ in their blur at all. Air that only shifts moves edges over a px and away, and to
// weigh by that costs 0.7 dB, where it gains 0.9 if the blur changes.
class LuckSpread {
 public:
  // Steady frames of one scene, all of one size, and what of them does not show it (CV_8UC1, not 0).
  void Add(const cv::Mat& frame, const cv::Mat& hidden);

  // Between the tenth of the frames with the least and with the most energy, over a Gaussian of 12 px, which
  // shifts do not tell: the median over the half of the scene that has most detail. On clips of Shimmer's 0.4
  // to 1.3 where the blur changes, 0.1 to 0.25 where it does not. 0 for fewer than 4 frames.
  double Octaves() const;

 private:
  std::vector<cv::Mat> energies_;  // CV_32FC1 at a quarter of the size, octaves; NaN where hidden
};

inline constexpr double kLeastLuck_octaves = 0.33;

// Frames of a video that luck is worth its noise in: of fewer the luckiest are one or two at a px, and these
// change from px to px with the tilt that they have left, and straight lines become jagged.
inline constexpr int64_t kLeastLuckyFrames = 12;

}  // namespace shimmer::restore
