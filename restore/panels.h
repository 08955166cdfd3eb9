// Images of many channels, laid out for products of matrices.
#pragma once

#include <opencv2/core.hpp>
#include <utility>

#include "restore/workspace.h"

namespace shimmer::restore {

constexpr int kPanelPx = 16;  // px of a row that lie together; whole vectors on every SIMD target

inline size_t PanelsFor(int px) { return (static_cast<size_t>(px) + kPanelPx - 1) / kPanelPx; }

// [row][panel][channel][px of the panel]: a panel's channels are the columns of a right-hand matrix without
// any packing. What lies in a row's last panel beyond its width is not specified. The memory is a
// workspace's, which must outlive this.
class Panels {
 public:
  Panels(int channels, cv::Size size, Workspace& workspace)
      : channels_(channels),
        size_(size),
        stride_(static_cast<size_t>(channels) * kPanelPx),
        workspace_(&workspace),
        piece_(workspace.TakePiece((static_cast<size_t>(size.height) * RowPanels() + 2) * stride_)) {}
  Panels(Panels&& from) noexcept { Swap(from); }
  Panels& operator=(Panels&& from) noexcept {
    Panels taken(std::move(from));
    Swap(taken);
    return *this;
  }
  ~Panels() { Free(); }

  // Gives the memory back; there are no px any more.
  void Free() {
    if (piece_.floats) workspace_->GiveBack(std::move(piece_));
  }

  int Channels() const { return channels_; }
  cv::Size Size() const { return size_; }
  size_t RowPanels() const { return PanelsFor(size_.width); }
  size_t PanelStride() const { return stride_; }  // floats from a panel to the next

  // panel in [-1, RowPanels()]: those outside may be pointed to.
  float* At(int y, ptrdiff_t panel) { return piece_.floats.get() + Offset(y, panel); }
  const float* At(int y, ptrdiff_t panel) const { return piece_.floats.get() + Offset(y, panel); }

 private:
  size_t Offset(int y, ptrdiff_t panel) const {
    return (static_cast<size_t>(y) * RowPanels() + static_cast<size_t>(panel + 1)) * stride_;
  }
  void Swap(Panels& other) noexcept {
    std::swap(channels_, other.channels_);
    std::swap(size_, other.size_);
    std::swap(stride_, other.stride_);
    std::swap(workspace_, other.workspace_);
    std::swap(piece_, other.piece_);
  }

  int channels_ = 0;
  cv::Size size_;
  size_t stride_ = 0;
  Workspace* workspace_ = nullptr;
  Piece piece_;
};

}  // namespace shimmer::restore
