// A Restormer in double, by plain loops over whole images: the truth that the fast one is held to.
#pragma once

#include <opencv2/core.hpp>

#include "restore/safe_tensors.h"

namespace shimmer::restore {

// image: CV_32FC3. The result is CV_64FC3.
cv::Mat RestormerTwin(const SafeTensors& file, const cv::Mat& image);

}  // namespace shimmer::restore
