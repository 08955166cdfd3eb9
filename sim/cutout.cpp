#include "sim/cutout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "sim/unit_vector.h"

namespace shimmer::sim {
namespace {

constexpr int kBorder_px = 2;

cv::Mat WithBorder(const cv::Mat& rgba) {
  cv::Mat wide = cv::Mat::zeros(rgba.rows + 2 * kBorder_px, rgba.cols + 2 * kBorder_px, CV_32FC4);
  rgba.copyTo(wide(cv::Rect({kBorder_px, kBorder_px}, rgba.size())));
  return wide;
}

// Means of four samples; what an odd side lacks is transparent.
cv::Mat Half(const cv::Mat& rgba) {
  cv::Mat half = cv::Mat::zeros((rgba.rows + 1) / 2, (rgba.cols + 1) / 2, CV_32FC4);
  for (int y = 0; y < rgba.rows; ++y)
    for (int x = 0; x < rgba.cols; ++x) half.at<cv::Vec4f>(y / 2, x / 2) += rgba.at<cv::Vec4f>(y, x) * 0.25f;
  return half;
}

std::array<float, 4> CatmullRom(float t) {
  return {((-0.5f * t + 1) * t - 0.5f) * t, (1.5f * t - 2.5f) * t * t + 1, ((-1.5f * t + 2) * t + 0.5f) * t,
          (0.5f * t - 0.5f) * t * t};
}

// At (x, y) of the picture within its border; transparent beyond.
cv::Vec4f SampleAt(const cv::Mat& bordered, double x, double y) {
  const int left = cvFloor(x), top = cvFloor(y);
  const int first_x = left - 1 + kBorder_px, first_y = top - 1 + kBorder_px;
  if (first_x + 3 < 0 || first_y + 3 < 0 || first_x >= bordered.cols || first_y >= bordered.rows) return {};
  const auto across = CatmullRom(static_cast<float>(x - left)),
             down = CatmullRom(static_cast<float>(y - top));
  cv::Vec4f sum;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      const int row = first_y + j, column = first_x + i;
      if (row >= 0 && row < bordered.rows && column >= 0 && column < bordered.cols)
        sum += bordered.at<cv::Vec4f>(row, column) *
               (down[static_cast<size_t>(j)] * across[static_cast<size_t>(i)]);
    }
  const float alpha = std::clamp(sum[3], 0.0f, 1.0f);
  return {std::clamp(sum[0], 0.0f, alpha), std::clamp(sum[1], 0.0f, alpha), std::clamp(sum[2], 0.0f, alpha),
          alpha};
}

}  // namespace

Cutout::Cutout(const cv::Mat& rgba) {
  if (rgba.type() != CV_32FC4 || rgba.empty())
    throw std::invalid_argument("Cutout: must be CV_32FC4 and not empty");
  halved_.push_back(rgba);
  while (std::max(halved_.back().rows, halved_.back().cols) > 1) halved_.push_back(Half(halved_.back()));
  for (cv::Mat& picture : halved_) picture = WithBorder(picture);
}

int64_t Cutout::bytes() const {
  int64_t bytes = 0;
  for (const cv::Mat& picture : halved_) bytes += static_cast<int64_t>(picture.total() * picture.elemSize());
  return bytes;
}

Layer Cutout::Draw(double height_px, const Pose& pose, cv::Rect within) const {
  const cv::Size whole(halved_[0].cols - 2 * kBorder_px, halved_[0].rows - 2 * kBorder_px);
  double px_per_sample = height_px * pose.scale / whole.height;
  if (!(px_per_sample > 0)) return {};
  size_t level = 0;
  int step = 1;  // samples of the whole picture to one of this level
  for (; px_per_sample * step <= 0.5 && level + 1 < halved_.size(); step *= 2) ++level;
  const cv::Point2d along = UnitVector(pose.turns), across(-along.y, along.x);
  const cv::Point2d reach((whole.width / 2.0 + 2 * step) * px_per_sample,
                          (whole.height / 2.0 + 2 * step) * px_per_sample);
  const double half_width = std::abs(along.x) * reach.x + std::abs(across.x) * reach.y,
               half_height = std::abs(along.y) * reach.x + std::abs(across.y) * reach.y;
  const cv::Point2d half(half_width, half_height);
  const cv::Rect area = PixelsWithin(within, pose.centre - half, pose.centre + half);
  if (area.empty()) return {};
  Layer layer{area, cv::Mat(area.size(), CV_32FC4)};
  for (int y = 0; y < area.height; ++y)
    for (int x = 0; x < area.width; ++x) {
      const cv::Point2d off = (cv::Point2d(area.x + x, area.y + y) - pose.centre) / px_per_sample;
      // Sample i of a level is the square from i step to (i + 1) step of the whole picture.
      layer.rgba.at<cv::Vec4f>(y, x) =
          SampleAt(halved_[level], (off.dot(along) + whole.width / 2.0) / step - 0.5,
                   (off.dot(across) + whole.height / 2.0) / step - 0.5);
    }
  return layer;
}

}  // namespace shimmer::sim
