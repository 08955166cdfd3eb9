#include "sim/layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "sim/colour.h"
#include "sim/pack_rows.h"

namespace shimmer::sim {
namespace {

// The layer as part of a wider area, transparent where it is not.
Layer Widened(const Layer& layer, cv::Rect area) {
  if (area == layer.area) return layer;
  cv::Mat wider = cv::Mat::zeros(area.size(), CV_32FC4);
  if (!layer.area.empty()) layer.rgba.copyTo(wider(layer.area - area.tl()));
  return {area, wider};
}

// near over far, in far.
void LayOver(const Layer& near, Layer& far) {
  far = Widened(far, far.area | near.area);
  for (int y = 0; y < near.area.height; ++y) {
    const auto* over = near.rgba.ptr<cv::Vec4f>(y);
    auto* under = far.rgba.ptr<cv::Vec4f>(near.area.y + y - far.area.y) + (near.area.x - far.area.x);
    for (int x = 0; x < near.area.width; ++x) under[x] = over[x] + under[x] * (1 - over[x][3]);
  }
}

}  // namespace

cv::Rect PixelsWithin(cv::Rect within, cv::Point2d low, cv::Point2d high) {
  // In doubles until it is within: an object may be larger than any int.
  const auto cut = [](double px, int least, int most) {
    return static_cast<int>(std::clamp<double>(px, least, most));
  };
  const cv::Point last = within.br(),
                  first(cut(std::floor(low.x), within.x, last.x), cut(std::floor(low.y), within.y, last.y)),
                  end(cut(std::ceil(high.x) + 1, within.x, last.x),
                      cut(std::ceil(high.y) + 1, within.y, last.y));
  const cv::Rect area(first, end);
  return area.empty() ? cv::Rect() : area;
}

std::vector<Layer> Flattened(std::vector<Layer> layers) {
  std::vector<Layer> flat;
  for (Layer& layer : layers) {
    if (layer.area.empty()) continue;
    // Those that it meets, the farther first, and what the wider area meets then.
    Layer merged{{}, {}};
    cv::Rect area = layer.area;
    bool found = true;
    std::vector<Layer> apart = std::move(flat), met;
    while (found) {
      found = false;
      std::vector<Layer> rest;
      for (Layer& other : apart) {
        if ((other.area & area).empty()) {
          rest.push_back(std::move(other));
          continue;
        }
        area |= other.area, found = true;
        met.push_back(std::move(other));
      }
      apart = std::move(rest);
    }
    for (const Layer& other : met)  // they do not meet one another: in any order
      if (merged.area.empty())
        merged = {other.area, other.rgba.clone()};
      else
        LayOver(other, merged);
    if (merged.area.empty())
      merged = std::move(layer);
    else
      LayOver(layer, merged);
    flat = std::move(apart);
    flat.push_back(std::move(merged));
  }
  return flat;
}

void Composite(const Layer& layer, cv::Point origin, bool linear_light, cv::Mat& frame) {
  const int channels = frame.channels();
  if ((frame.depth() != CV_8U && frame.depth() != CV_16U && frame.depth() != CV_32F) ||
      (channels != 1 && channels != 3))
    throw std::invalid_argument("Composite: frame must be CV_8U, CV_16U or CV_32F of 1 or 3 channels");
  const cv::Rect seen = layer.area & cv::Rect(origin, frame.size());
  const auto width = static_cast<size_t>(seen.width);
  std::array<std::vector<float>, 3> light;
  for (auto& plane : light) plane.resize(width);
  for (int y = seen.y; y < seen.y + seen.height; ++y) {
    const auto* rgba = layer.rgba.ptr<cv::Vec4f>(y - layer.area.y) + (seen.x - layer.area.x);
    for (size_t end = 0, x = 0; x < width; x = end) {  // stretches that are covered
      while (x < width && rgba[x][3] <= 0) ++x;
      for (end = x; end < width && rgba[end][3] > 0;) ++end;
      const size_t count = end - x;
      if (count == 0) break;
      const cv::Point first = cv::Point(seen.x + static_cast<int>(x), y) - origin;
      std::array<float*, 3> rows{};
      for (size_t c = 0; c < static_cast<size_t>(channels); ++c) rows[c] = light[c].data() + x;
      UnpackRow(frame, first, count, rows.data());
      for (size_t c = 0; c < static_cast<size_t>(channels); ++c) {
        if (linear_light) DecodeSrgbRow({rows[c], count});
        for (size_t i = 0; i < count; ++i) {
          const cv::Vec4f& over = rgba[x + i];
          const float own = channels == 1 ? (over[0] + over[1] + over[2]) / 3 : over[static_cast<int>(c)];
          rows[c][i] = own + (1 - over[3]) * rows[c][i];
        }
        if (linear_light) EncodeSrgbRow({rows[c], count});
      }
      const std::array<const float*, 3> from = {rows[0], rows[1], rows[2]};
      PackRow(std::span(from).first(static_cast<size_t>(channels)), count, first, frame);
    }
  }
}

void AddCoverage(const Layer& layer, cv::Point origin, cv::Mat& mask) {
  const cv::Rect seen = layer.area & cv::Rect(origin, mask.size());
  for (int y = seen.y; y < seen.y + seen.height; ++y)
    for (int x = seen.x; x < seen.x + seen.width; ++x) {
      const float alpha = layer.rgba.at<cv::Vec4f>(y - layer.area.y, x - layer.area.x)[3];
      float& covered = mask.at<float>(y - origin.y, x - origin.x);
      covered = alpha + (1 - alpha) * covered;
    }
}

void LayerMean::Add(const Layer& layer) {
  ++layers_;
  if (layer.area.empty()) return;
  if (sum_.area.empty()) {
    sum_ = {layer.area, layer.rgba.clone()};
    return;
  }
  sum_ = Widened(sum_, sum_.area | layer.area);
  cv::Mat part = sum_.rgba(layer.area - sum_.area.tl());
  part += layer.rgba;
}

Layer LayerMean::Mean() const {
  if (layers_ == 0) throw std::logic_error("LayerMean: of no layers");
  return {sum_.area, sum_.area.empty() ? cv::Mat() : cv::Mat(sum_.rgba / layers_)};
}

}  // namespace shimmer::sim
