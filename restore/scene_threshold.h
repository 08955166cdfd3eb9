// From where on a pixel is no part of the still scene, by what turbulence and noise do to the samples.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "restore/scene_sample.h"

namespace shimmer::restore {

// How far turbulence moves the scene along its gradients, px RMS, from the steepest pixels: what moves by
// itself is a small part of them.
double TiltOf(const cv::Mat& picture, const std::vector<SceneSample>& samples);

// In levels, no less than noise explains: of all pixels together (Otsu's, divided as the paper's authors do).
// distances: of the samples, of DistanceTo.
double PooledThreshold(const cv::Mat& picture, const std::vector<SceneSample>& samples,
                       const std::vector<cv::Mat>& distances);

// In levels by pixel (CV_32FC1), at least `least`: twice what 19 of 20 pixels with the same excess (of
// ExcessOf) keep within, of pixels that are known (CV_8UC1, not 0) and where nothing is seen to move. Blur
// that comes and goes takes fine texture out of its interval as much as tilt does.
cv::Mat ThresholdsByExcess(const cv::Mat& excess, const std::vector<SceneSample>& samples,
                           const std::vector<cv::Mat>& distances, const cv::Mat& known, double least);

}  // namespace shimmer::restore
