#include "restore/local_interval.h"

#include <opencv2/imgproc.hpp>

#include "restore/levels.h"
#include "restore/mask_cleaning.h"

namespace shimmer::restore {
namespace {

constexpr double kSmooth_px = 1.5;

cv::Mat Smoothed(const cv::Mat& levels) {
  cv::Mat smooth;
  cv::GaussianBlur(MostOfChannels(levels), smooth, {0, 0}, kSmooth_px, 0, cv::BORDER_REPLICATE);
  return smooth;
}

}  // namespace

LocalInterval IntervalOf(const cv::Mat& scene, int radius_px) {
  LocalInterval interval;
  const cv::Mat disc = Disc(radius_px);
  cv::erode(scene, interval.low, disc);
  cv::dilate(scene, interval.high, disc);
  return interval;
}

cv::Mat DistanceTo(const LocalInterval& interval, const cv::Mat& frame) {
  const cv::Mat above = frame - interval.high, below = interval.low - frame;
  return Smoothed(cv::max(cv::Mat(cv::max(above, below)), 0));
}

cv::Mat ExcessOf(const LocalInterval& narrow, const LocalInterval& wide) {
  return Smoothed((wide.high - narrow.high) + (narrow.low - wide.low));
}

}  // namespace shimmer::restore
