// A mask from how far each pixel is from still, cleaned in space and time.
#pragma once

#include <opencv2/core.hpp>

namespace shimmer::restore {

// To grow and shrink masks by.
cv::Mat Disc(int radius_px);

// CV_8UC1, 255 or 0. distance: CV_32FC1. Objects are groups of at least least_px pixels beyond the threshold,
// of which a pixel is sure (sure: CV_8UC1, not 0), gaps of up to 8 px closed, and holes in them of less than
// half of what they enclose filled.
cv::Mat MovingObjects(const cv::Mat& distance, double threshold, const cv::Mat& sure, int least_px);

// The objects of `mask` that hold at least least_px pixels of the places (CV_8UC1, not 0).
cv::Mat Holding(const cv::Mat& mask, const cv::Mat& places, int least_px);

// The objects of `mask` that meet one of the frame before or after it, grown by reach_px. An empty Mat: there
// is no such frame; all of the mask where there is neither.
cv::Mat Persistent(const cv::Mat& mask, const cv::Mat& before, const cv::Mat& after, int reach_px);

}  // namespace shimmer::restore
