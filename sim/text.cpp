#include "sim/text.h"

#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace shimmer::sim {

cv::Mat TextCutout(const std::string& text, const cv::Vec3f& colour) {
  constexpr int kFont = cv::FONT_HERSHEY_DUPLEX, kThickness_px = 9, kBorder_px = 24;
  const double scale = cv::getFontScaleFromHeight(kFont, 64, kThickness_px);
  int below_px = 0;
  const cv::Size size = cv::getTextSize(text, kFont, scale, kThickness_px, &below_px);
  cv::Mat drawn =
      cv::Mat::zeros(size.height + below_px + 2 * kBorder_px, size.width + 2 * kBorder_px, CV_8UC1);
  cv::putText(drawn, text, {kBorder_px, kBorder_px + size.height}, kFont, scale, cv::Scalar(255),
              kThickness_px, cv::LINE_AA);
  cv::Rect inked = cv::boundingRect(drawn);
  if (inked.empty()) throw std::invalid_argument("text \"" + text + "\": has nothing that can be seen");
  inked = (inked - cv::Point(1, 1) + cv::Size(2, 2)) & cv::Rect({}, drawn.size());
  cv::Mat rgba(inked.size(), CV_32FC4);
  for (int y = 0; y < inked.height; ++y)
    for (int x = 0; x < inked.width; ++x) {
      const float alpha = static_cast<float>(drawn.at<uint8_t>(inked.y + y, inked.x + x)) / 255.0f;
      rgba.at<cv::Vec4f>(y, x) = cv::Vec4f(colour[0], colour[1], colour[2], 1) * alpha;
    }
  return rgba;
}

}  // namespace shimmer::sim
