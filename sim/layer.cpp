#include "sim/layer.h"

#include <stdexcept>

namespace shimmer::sim {

void Composite(const Layer& layer, cv::Point origin, cv::Mat& frame, cv::Mat& mask) {
  if ((frame.type() != CV_32FC3 && frame.type() != CV_32FC1) || mask.type() != CV_32FC1 ||
      frame.size() != mask.size())
    throw std::invalid_argument(
        "Composite: frame must be CV_32FC3 or CV_32FC1 with a CV_32FC1 mask of its size");
  const cv::Rect seen = layer.area & cv::Rect(origin, frame.size());
  const bool grey = frame.channels() == 1;
  for (int y = seen.y; y < seen.y + seen.height; ++y) {
    const auto* rgba = layer.rgba.ptr<cv::Vec4f>(y - layer.area.y) + (seen.x - layer.area.x);
    float* light = frame.ptr<float>(y - origin.y, seen.x - origin.x);
    float* covered = mask.ptr<float>(y - origin.y, seen.x - origin.x);
    for (int x = 0; x < seen.width; ++x) {
      const cv::Vec4f& over = rgba[x];
      const float through = 1 - over[3];
      if (grey) {
        light[x] = (over[0] + over[1] + over[2]) / 3 + through * light[x];
      } else {
        for (int c = 0; c < 3; ++c) light[3 * x + c] = over[c] + through * light[3 * x + c];
      }
      covered[x] = over[3] + through * covered[x];
    }
  }
}

void LayerMean::Add(const Layer& layer) {
  ++layers_;
  if (layer.area.empty()) return;
  const cv::Rect area = sum_.area.empty() ? layer.area : sum_.area | layer.area;
  if (area != sum_.area) {
    cv::Mat wider = cv::Mat::zeros(area.size(), CV_32FC4);
    if (!sum_.area.empty()) sum_.rgba.copyTo(wider(sum_.area - area.tl()));
    sum_ = {area, wider};
  }
  cv::Mat part = sum_.rgba(layer.area - area.tl());
  part += layer.rgba;
}

Layer LayerMean::Mean() const {
  if (layers_ == 0) throw std::logic_error("LayerMean: of no layers");
  return {sum_.area, sum_.area.empty() ? cv::Mat() : cv::Mat(sum_.rgba / layers_)};
}

}  // namespace shimmer::sim
