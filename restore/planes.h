// Pictures as networks have them: one plane a channel.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::restore {

// 3 x H x W floats as a picture CV_32FC3, and back.
cv::Mat PictureOfPlanes(const float* planes, cv::Size size);
std::vector<float> PlanesOf(const cv::Mat& picture);

}  // namespace shimmer::restore
