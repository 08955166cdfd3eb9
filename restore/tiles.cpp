#include "restore/tiles.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace shimmer::restore {
namespace {

// Where tiles begin along an axis.
std::vector<int> Starts(int length, int side, int overlap) {
  if (side >= length) return {0};
  const int count = 1 + (length - side + side - overlap - 1) / (side - overlap);
  std::vector<int> starts;
  for (int k = 0; k < count; ++k)
    starts.push_back(static_cast<int>(static_cast<int64_t>(k) * (length - side) / (count - 1)));
  return starts;
}

// A tile's weight along an axis, at each of its px.
std::vector<float> Ramp(int start, int side, int length, int overlap) {
  std::vector<float> weights(static_cast<size_t>(side), 1.f);
  for (int i = 0; i < side; ++i) {
    const int before = start > 0 ? i : overlap, after = start + side < length ? side - 1 - i : overlap;
    const float px = static_cast<float>(std::min({before, after, overlap}));
    weights[static_cast<size_t>(i)] = (px + 0.5f) / (static_cast<float>(overlap) + 0.5f);
  }
  return weights;
}

}  // namespace

std::vector<cv::Rect> Tiles(cv::Size frame, int side_px, int overlap_px) {
  if (overlap_px < 0 || 2 * overlap_px >= side_px)
    throw std::invalid_argument("tiles of " + std::to_string(side_px) + " px that overlap by " +
                                std::to_string(overlap_px) + " px: must overlap by less than half");
  const cv::Size size{std::min(side_px, frame.width), std::min(side_px, frame.height)};
  std::vector<cv::Rect> tiles;
  for (const int y : Starts(frame.height, side_px, overlap_px))
    for (const int x : Starts(frame.width, side_px, overlap_px)) tiles.emplace_back(cv::Point(x, y), size);
  return tiles;
}

TileSum::TileSum(cv::Size frame, int overlap_px) : frame_(frame), overlap_px_(overlap_px) {}

void TileSum::Add(const cv::Mat& tile, cv::Rect place) {
  if (sum_.empty()) {
    sum_ = cv::Mat::zeros(frame_, tile.type());
    weights_ = cv::Mat::zeros(frame_, CV_32FC1);
  }
  const std::vector<float> across = Ramp(place.x, place.width, frame_.width, overlap_px_),
                           down = Ramp(place.y, place.height, frame_.height, overlap_px_);
  const int channels = tile.channels();
  for (int y = 0; y < place.height; ++y) {
    const float* from = tile.ptr<float>(y);
    float* sum = sum_.ptr<float>(place.y + y) + place.x * channels;
    float* weights = weights_.ptr<float>(place.y + y) + place.x;
    for (int x = 0; x < place.width; ++x) {
      const float weight = across[static_cast<size_t>(x)] * down[static_cast<size_t>(y)];
      weights[x] += weight;
      for (int c = 0; c < channels; ++c) sum[x * channels + c] += weight * from[x * channels + c];
    }
  }
}

cv::Mat TileSum::Whole() const {
  cv::Mat whole(sum_.size(), sum_.type());
  const int channels = sum_.channels();
  for (int y = 0; y < whole.rows; ++y) {
    const float* sum = sum_.ptr<float>(y);
    const float* weights = weights_.ptr<float>(y);
    float* to = whole.ptr<float>(y);
    for (int x = 0; x < whole.cols; ++x)
      for (int c = 0; c < channels; ++c) to[x * channels + c] = sum[x * channels + c] / weights[x];
  }
  return whole;
}

}  // namespace shimmer::restore
