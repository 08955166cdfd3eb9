#include "sim/app/colour_maps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

namespace shimmer::app {
namespace {

// Red, green or blue (c = 0, 1, 2) of the full hue: 1 within a sixth of a turn of the channel's own hue, 0
// beyond a third, a straight line between.
double ChannelOfHue(double hue_turns, int c) {
  const double away = hue_turns - c / 3.0;
  return std::clamp(2 - 6 * std::abs(away - std::floor(away + 0.5)), 0.0, 1.0);
}

}  // namespace

cv::Mat TiltAsColours(const cv::Mat& dx_dy, double full_scale_px) {
  if (dx_dy.type() != CV_32FC2) throw std::invalid_argument("tilt to show must be CV_32FC2");
  if (!(full_scale_px > 0))
    throw std::invalid_argument("full scale of tilt colours = " + std::to_string(full_scale_px) +
                                " px, must be > 0");
  cv::Mat colours(dx_dy.size(), CV_8UC3);
  for (int y = 0; y < dx_dy.rows; ++y) {
    for (int x = 0; x < dx_dy.cols; ++x) {
      const auto shift = dx_dy.at<cv::Vec2f>(y, x);
      auto& colour = colours.at<cv::Vec3b>(y, x);
      if (!std::isfinite(shift[0]) || !std::isfinite(shift[1])) {
        colour = cv::Vec3b::all(kNotFiniteGrey);
        continue;
      }
      const double saturation = std::min(1.0, std::hypot(shift[0], shift[1]) / full_scale_px);
      const double hue_turns = std::atan2(shift[1], shift[0]) / (2 * std::numbers::pi);
      for (int c = 0; c < 3; ++c)
        colour[c] = cv::saturate_cast<uchar>(255 * (1 - saturation * (1 - ChannelOfHue(hue_turns, c))));
    }
  }
  return colours;
}

cv::Mat SigmaAsHeat(const cv::Mat& sigma, double low, double high) {
  if (sigma.type() != CV_32FC1) throw std::invalid_argument("sigma to show must be CV_32FC1");
  if (!(low < high))
    throw std::invalid_argument("ends of the sigma colours = " + std::to_string(low) + ", " +
                                std::to_string(high) + ", must rise");
  cv::Mat levels(sigma.size(), CV_8UC1), colours;
  cv::Mat unknown(sigma.size(), CV_8UC1, cv::Scalar(0));
  for (int y = 0; y < sigma.rows; ++y) {
    for (int x = 0; x < sigma.cols; ++x) {
      const double value = sigma.at<float>(y, x);
      unknown.at<uchar>(y, x) = std::isfinite(value) ? 0 : 255;
      const double share = std::isfinite(value) ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0;
      levels.at<uchar>(y, x) = cv::saturate_cast<uchar>(255 * share);
    }
  }
  cv::applyColorMap(levels, colours, cv::COLORMAP_INFERNO);
  cv::cvtColor(colours, colours, cv::COLOR_BGR2RGB);
  colours.setTo(cv::Scalar::all(kNotFiniteGrey), unknown);
  return colours;
}

}  // namespace shimmer::app
