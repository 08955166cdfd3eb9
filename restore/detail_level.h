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

// The detail of a grey level: less noise, less its local mean and divided by its local root mean square, so
// that neither the light nor a few strong edges count, but all of the frame does. Where that root mean square
// is below least_contrast (in grey's unit, above 0) detail fades: it is noise.
struct Detail {
  cv::Mat values;   // CV_32FC1, root mean square about 1 where there is texture
  double contrast;  // root mean square over the frame, in grey's unit, before it was divided
};
Detail DetailOf(const cv::Mat& grey, double least_contrast);

}  // namespace shimmer::restore
