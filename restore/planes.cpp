#include "restore/planes.h"

namespace shimmer::restore {

cv::Mat PictureOfPlanes(const float* planes, cv::Size size) {
  std::vector<cv::Mat> channels;
  for (int c = 0; c < 3; ++c)
    channels.emplace_back(size, CV_32FC1,
                          const_cast<float*>(planes) + static_cast<ptrdiff_t>(c) * size.area());
  cv::Mat picture;
  cv::merge(channels, picture);
  return picture;
}

std::vector<float> PlanesOf(const cv::Mat& picture) {
  std::vector<float> planes(picture.total() * 3);
  std::vector<cv::Mat> channels;
  for (int c = 0; c < 3; ++c)
    channels.emplace_back(picture.size(), CV_32FC1, planes.data() + static_cast<size_t>(c) * picture.total());
  cv::split(picture, channels);
  return planes;
}

}  // namespace shimmer::restore
