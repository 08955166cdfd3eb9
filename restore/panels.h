// Images of many channels, laid out for products of matrices.
#pragma once

#include <hwy/aligned_allocator.h>

#include <opencv2/core.hpp>

namespace shimmer::restore {

constexpr int kPanelPx = 16;  // px of a row that lie together; whole vectors on every SIMD target

inline size_t PanelsFor(int px) { return (static_cast<size_t>(px) + kPanelPx - 1) / kPanelPx; }

// Floats whose values are not set, aligned for every SIMD target.
using Floats = hwy::AlignedFreeUniquePtr<float[]>;
inline Floats MakeFloats(size_t count) { return hwy::AllocateAligned<float>(count); }

// [row][panel][channel][px of the panel]: a panel's channels are the columns of a right-hand matrix without
// any packing. What lies in a row's last panel beyond its width is not specified.
class Panels {
 public:
  Panels() = default;
  Panels(int channels, cv::Size size)
      : channels_(channels), size_(size), stride_(static_cast<size_t>(channels) * kPanelPx) {
    data_ = MakeFloats((static_cast<size_t>(size.height) * RowPanels() + 2) * stride_);
  }

  int Channels() const { return channels_; }
  cv::Size Size() const { return size_; }
  size_t RowPanels() const { return PanelsFor(size_.width); }
  size_t PanelStride() const { return stride_; }  // floats from a panel to the next

  // panel in [-1, RowPanels()]: those outside may be pointed to.
  float* At(int y, ptrdiff_t panel) { return data_.get() + Offset(y, panel); }
  const float* At(int y, ptrdiff_t panel) const { return data_.get() + Offset(y, panel); }

 private:
  size_t Offset(int y, ptrdiff_t panel) const {
    return (static_cast<size_t>(y) * RowPanels() + static_cast<size_t>(panel + 1)) * stride_;
  }

  int channels_ = 0;
  cv::Size size_;
  size_t stride_ = 0;
  Floats data_;
};

}  // namespace shimmer::restore
