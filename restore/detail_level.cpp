#include "restore/detail_level.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace shimmer::restore {
namespace {

constexpr int kFineSide = 256, kCoarseSide = 64;  // px that the shorter side keeps
constexpr double kNoiseSigma_px = 1;              // of the level
constexpr int kLocalSide_px = 15;                 // of the box whose mean, taken twice, is the local one

}  // namespace

LevelScales LevelScalesOf(cv::Size size) {
  const int side = std::min(size.width, size.height);
  int fine = 1;
  while (side / (2 * fine) >= kFineSide) fine *= 2;
  return {fine, side / (2 * fine) >= kCoarseSide ? 2 * fine : fine};
}

cv::Mat ReducedGrey(const cv::Mat& frame, int scale) {
  const int channels = frame.channels();
  if (frame.empty() || scale < 1 || frame.cols < scale || frame.rows < scale)
    throw std::invalid_argument("ReducedGrey: the frame is empty or smaller than scale");
  if ((frame.depth() != CV_8U && frame.depth() != CV_16U && frame.depth() != CV_32F) || channels == 2 ||
      channels > 4)
    throw std::invalid_argument("ReducedGrey: frame must be CV_8U, CV_16U or CV_32F of 1, 3 or 4 channels");
  const cv::Size size(frame.cols / scale, frame.rows / scale);
  cv::Mat grey = frame({0, 0, size.width * scale, size.height * scale});
  if (scale > 1) cv::resize(grey, grey, size, 0, 0, cv::INTER_AREA);
  if (channels > 1) {
    cv::Mat samples;
    grey.convertTo(samples, CV_32F);
    cv::Mat_<float> mean = cv::Mat_<float>::zeros(1, channels);
    mean.colRange(0, 3) = 1 / 3.0f;
    cv::transform(samples, grey, mean);
  } else {
    grey.convertTo(grey, CV_32F);
  }
  if (frame.depth() == CV_32F)
    for (int y = 0; y < size.height; ++y)
      for (float& value : cv::Mat_<float>(grey.row(y)))
        if (!std::isfinite(value)) value = 0;
  return grey;
}

Detail DetailOf(const cv::Mat& grey, double least_contrast) {
  const auto local_mean = [](const cv::Mat& of) {
    cv::Mat mean;
    cv::blur(of, mean, {kLocalSide_px, kLocalSide_px}, {-1, -1}, cv::BORDER_REFLECT);
    cv::blur(mean, mean, {kLocalSide_px, kLocalSide_px}, {-1, -1}, cv::BORDER_REFLECT);
    return mean;
  };
  cv::Mat values;
  cv::GaussianBlur(grey, values, {0, 0}, kNoiseSigma_px, 0, cv::BORDER_REFLECT_101);
  values -= local_mean(values);
  const double contrast = cv::norm(values) / std::sqrt(static_cast<double>(values.total()));
  cv::Mat local = local_mean(values.mul(values));
  local += least_contrast * least_contrast;
  cv::sqrt(local, local);
  cv::divide(values, local, values);
  return {values, contrast};
}

}  // namespace shimmer::restore
