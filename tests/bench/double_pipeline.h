// The model in double, frame by frame: what the benchmarks measure errors against.
#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "sim/clip.h"

namespace shimmer::bench {

struct ExactShifts {
  cv::Mat dx, dy;  // CV_64F in px, over the frame and a border
};
ExactShifts ExactTilt(const sim::TiltField& field, cv::Size size, int border_px, int64_t t);

// Sigma of each pixel of the frame, CV_32F in px. shifts have border_px around it.
cv::Mat ExactSigma(const sim::Scene& scene, const sim::BlurNoise& noise, const ExactShifts& shifts,
                   int border_px, int64_t t);

// Reads one plane, CV_32FC1, at (x, y).
using ReadPlane = std::function<double(const cv::Mat& plane, double x, double y)>;
double CatmullRom(const cv::Mat& plane, double x, double y);

// Pixel (x, y) of the result = clean at (x + margin_px + dx, y + margin_px + dy). clean: CV_32FC1 or C3, with
// enough around it; so is the result.
cv::Mat ExactWarp(const cv::Mat& clean, int margin_px, const ExactShifts& shifts, const ReadPlane& read);

// frame has border_px around the area of sigma: at least GaussianRadius of the largest.
cv::Mat ExactBlur(const cv::Mat& frame, int border_px, const cv::Mat& sigma);

// Pixels that lie within 1e-6 cells of a simplex face in some octave of either axis: where the kernel jumps,
// both sides are right. CV_8U, 255 where so.
cv::Mat OnFaces(const sim::TiltField& field, cv::Size size, int64_t t);

struct Error {
  double rms = 0, max = 0;
};
// Of all values of a against b, float or double with as many channels; pixels of `without` (CV_8U, or empty)
// aside. NaN if any value is.
Error ErrorOf(const cv::Mat& a, const cv::Mat& b, const cv::Mat& without = {});

}  // namespace shimmer::bench
