// The paper's line deviation: how far straight edges of a scene are from upright and level.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

namespace shimmer::restore {

// How lines are found: the paper gives no numbers, these are those of OpenCV's tutorial on Hough lines.
struct LineSearch {
  double canny_low = 50, canny_high = 200;  // gradient, Sobel 3x3, of 8-bit grey
  double distance_step_px = 1, angle_step_deg = 1;
  int votes = 50;  // edge pixels on a line
  double min_length_px = 50, max_gap_px = 10;
};

// Angle of a segment from the nearest of vertical and horizontal, degrees in [0, 45].
double AxisDeviation_deg(cv::Point from, cv::Point to);

// The mean of AxisDeviation_deg over the segments that a probabilistic Hough transform finds on the edges of
// a frame (levels.h; RGB as 0.299 R + 0.587 G + 0.114 B, rounded to 8 bits). Nothing where it finds none.
// Each segment counts the same; an end lies on a whole pixel, so one of 50 px is known within 1.6 degrees or
// so. The transform's own random numbers start anew on each call: the same frame gives the same number.
// Throws std::invalid_argument for what is no frame.
std::optional<double> LineDeviation_deg(const cv::Mat& frame, const LineSearch& search = {});

}  // namespace shimmer::restore
