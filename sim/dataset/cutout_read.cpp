#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/dataset/image_io.h"

namespace shimmer::dataset {
namespace {

float Sane(float sample) { return std::isfinite(sample) ? std::clamp(sample, -kMaxSample, kMaxSample) : 0; }

}  // namespace

CutoutPicture ReadCutout(const std::filesystem::path& path) {
  static const std::vector<std::string> kColour = {"R", "G", "B", "A"}, kGrey = {"Y", "A"};
  cv::Mat channels = ReadChannels(path, kColour);
  if (channels.empty()) channels = ReadChannels(path, kGrey);
  if (channels.empty())
    throw std::runtime_error(path.string() + ": has no alpha, must have it: it is to be cut out");
  const bool linear = path.extension() == ".exr", grey = channels.channels() == 2;
  CutoutPicture picture{cv::Mat(channels.size(), CV_32FC3), cv::Mat(channels.size(), CV_32FC1), linear};
  for (int y = 0; y < channels.rows; ++y)
    for (int x = 0; x < channels.cols; ++x) {
      const float* from = channels.ptr<float>(y) + x * channels.channels();
      const float alpha = std::clamp(Sane(from[grey ? 1 : 3]), 0.0f, 1.0f);
      const float colour_of = linear ? alpha : 1;  // OpenEXR: associated alpha
      picture.alpha.at<float>(y, x) = alpha;
      for (int c = 0; c < 3; ++c)
        picture.rgb.at<cv::Vec3f>(y, x)[c] = alpha > 0 ? Sane(from[grey ? 0 : c] / colour_of) : 0;
    }
  return picture;
}

}  // namespace shimmer::dataset
