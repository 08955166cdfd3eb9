// What the search for shifts looks at: a frame's detail, grey and smaller.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::restore {

// How many px of a frame of this size one px of a level stands for, along each axis: powers of two.
struct LevelScales {
  int fine;  // the shorter side keeps 256 px or more, if it has them: turbulence moves and blurs finer detail
  int coarse;  // the same or twice that: of the search through all shifts
};
LevelScales LevelScalesOf(cv::Size size);

// The grey frame (mean of its channels, in their own unit), reduced by means of scale x scale px; px at the
// right and lower edges that fill no square are left out. frame: CV_8U, CV_16U or CV_32F of 1, 3 or 4
// channels, of which the first three count. Samples that are not finite count as 0. CV_32FC1.
cv::Mat ReducedGrey(const cv::Mat& frame, int scale);

// The detail of a grey level: less noise, less its local mean (so that it has zero mean everywhere, whatever
// the light does), divided by its root mean square. A level without any stays near 0: contrast, that root
// mean square in grey's unit, says so.
struct Detail {
  cv::Mat values;  // CV_32FC1
  double contrast;
};
Detail DetailOf(const cv::Mat& grey);

}  // namespace shimmer::restore
