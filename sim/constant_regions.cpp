#include "sim/constant_regions.h"

#include <algorithm>
#include <cstring>

namespace shimmer::sim {
namespace {

constexpr int kBlock_px = 32;

int BlocksIn(int px) { return (px + kBlock_px - 1) / kBlock_px; }

// Rows are compared as bytes: first a row with itself, one pixel on, then the others with it.
bool BlockIsConstant(const cv::Mat& block) {
  const size_t pixel = block.elemSize(), row = pixel * static_cast<size_t>(block.cols);
  const uchar* first = block.ptr(0);
  if (std::memcmp(first, first + pixel, row - pixel) != 0) return false;
  for (int y = 1; y < block.rows; ++y)
    if (std::memcmp(first, block.ptr(y), row) != 0) return false;
  return true;
}

}  // namespace

ConstantRegions::ConstantRegions(const cv::Mat& frame)
    : frame_(frame), constant_(cv::Mat::zeros(BlocksIn(frame.rows), BlocksIn(frame.cols), CV_8U)) {
  const cv::Rect all({}, frame.size());
  for (int j = 0; j < constant_.rows; ++j)
    for (int i = 0; i < constant_.cols; ++i) {
      const cv::Rect block(i * kBlock_px, j * kBlock_px, kBlock_px, kBlock_px);
      const bool constant = BlockIsConstant(frame(block & all));
      constant_.at<uchar>(j, i) = constant;
      any_ = any_ || constant;
    }
}

bool ConstantRegions::IsConstant(cv::Rect area) const {
  if (!any_) return false;
  const int left = area.x / kBlock_px, right = (area.x + area.width - 1) / kBlock_px;
  const int top = area.y / kBlock_px, bottom = (area.y + area.height - 1) / kBlock_px;
  const uchar* colour = frame_.ptr(top * kBlock_px) + left * kBlock_px * frame_.elemSize();
  for (int j = top; j <= bottom; ++j)
    for (int i = left; i <= right; ++i) {
      const uchar* other = frame_.ptr(j * kBlock_px) + i * kBlock_px * frame_.elemSize();
      if (!constant_.at<uchar>(j, i) || std::memcmp(colour, other, frame_.elemSize()) != 0) return false;
    }
  return true;
}

void ConstantRegions::SetVaried(cv::Rect area) {
  const int left = area.x / kBlock_px, top = area.y / kBlock_px;
  constant_(cv::Rect(left, top, BlocksIn(area.br().x) - left, BlocksIn(area.br().y) - top)).setTo(0);
}

std::vector<cv::Range> ConstantRegions::Varied(cv::Rect area, int reach_px) const {
  if (!any_) return {{0, area.width}};
  const cv::Rect all({}, frame_.size());
  std::vector<cv::Range> varied;
  for (int start = 0; start < area.width; start += kBlock_px) {
    const int end = std::min(start + kBlock_px, area.width);
    const cv::Rect around(area.x + start - reach_px, area.y - reach_px, end - start + 2 * reach_px,
                          area.height + 2 * reach_px);
    if (IsConstant(around & all)) continue;
    if (!varied.empty() && varied.back().end == start)
      varied.back().end = end;
    else
      varied.emplace_back(start, end);
  }
  return varied;
}

}  // namespace shimmer::sim
