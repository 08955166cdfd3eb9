// What others would do first with turbulent frames, to hold the pipeline against: each simple, and written to
// be as good as it is simple.
#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "restore/frames.h"

namespace shimmer::restore {

enum class Baseline {
  kMean,     // of a px over time
  kMedian,   // likewise
  kLucky,    // lucky-region fusion (Aubailly et al. 2009): over time, the mean of where a frame is sharpest
  kSharpen,  // each frame by itself: unsharp masking
};

// Frames around one that go into its mean, median or fusion: as many as there are, if there are fewer. At the
// ends of a video they are those nearest that there are.
inline constexpr int kBaselineFrames = 25;

// Unsharp masking: frame + kUnsharpAmount (frame - Gaussian of the frame).
inline constexpr double kUnsharpSigma_px = 2, kUnsharpAmount = 1;

// Lucky-region fusion: a frame's weight at a px is the local mean of the squared Laplacian of its luma, over
// a Gaussian window, to this power. (High powers choose one frame, and show seams and noise.)
inline constexpr double kLuckySigma_px = 4, kLuckyPower = 2;

// video: steady frames, as levels.h takes them, of one size and type. sink gets each frame restored, in
// order, of that size and type. Memory: kBaselineFrames frames and their weights. The same on any number of
// threads. Throws std::invalid_argument for frames of two sizes or types, and what reading and the sink
// throw.
void RestoreSimply(Baseline baseline, Frames& video, const std::function<void(const cv::Mat&)>& sink);

}  // namespace shimmer::restore
