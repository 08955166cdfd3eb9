#include "restore/pixel_shuffle.h"

#include <tbb/parallel_for.h>

#include <cstring>

namespace shimmer::restore {
namespace {

constexpr size_t kHalf = kPanelPx / 2;

// Place of px x of channel 0 in a row.
size_t PlaceOf(const Panels& image, size_t x) { return x / kPanelPx * image.PanelStride() + x % kPanelPx; }

int Reflected(int at, int size) { return cv::borderInterpolate(at, size, cv::BORDER_REFLECT_101); }

int RoundedUp(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

}  // namespace

Panels Unshuffled(const Panels& image, Workspace& workspace) {
  Panels to(4 * image.Channels(), {image.Size().width / 2, image.Size().height / 2}, workspace);
  tbb::parallel_for(0, to.Size().height, [&](int y) {
    for (int j = 0; j < 2; ++j)
      for (size_t panel = 0; panel < image.RowPanels(); ++panel) {
        const float* from = image.At(2 * y + j, static_cast<ptrdiff_t>(panel));
        float* half = to.At(y, static_cast<ptrdiff_t>(panel / 2)) + panel % 2 * kHalf;
        for (size_t c = 0; c < static_cast<size_t>(image.Channels()); ++c) {
          const float* px = from + c * kPanelPx;
          float *even = half + (4 * c + 2 * static_cast<size_t>(j)) * kPanelPx, *odd = even + kPanelPx;
          for (size_t x = 0; x < kHalf; ++x) {
            even[x] = px[2 * x];
            odd[x] = px[2 * x + 1];
          }
        }
      }
  });
  return to;
}

void Shuffle(const Panels& image, Panels& to) {
  tbb::parallel_for(0, image.Size().height, [&](int y) {
    for (int j = 0; j < 2; ++j)
      for (size_t panel = 0; panel < to.RowPanels(); ++panel) {
        const float* half = image.At(y, static_cast<ptrdiff_t>(panel / 2)) + panel % 2 * kHalf;
        float* row = to.At(2 * y + j, static_cast<ptrdiff_t>(panel));
        for (size_t c = 0; c < static_cast<size_t>(image.Channels()) / 4; ++c) {
          const float *even = half + (4 * c + 2 * static_cast<size_t>(j)) * kPanelPx, *odd = even + kPanelPx;
          float* px = row + c * kPanelPx;
          for (size_t x = 0; x < kHalf; ++x) {
            px[2 * x] = even[x];
            px[2 * x + 1] = odd[x];
          }
        }
      }
  });
}

void CopyChannels(const Panels& from, int first, Panels& to) {
  tbb::parallel_for(0, from.Size().height, [&](int y) {
    for (ptrdiff_t panel = 0; panel < static_cast<ptrdiff_t>(from.RowPanels()); ++panel)
      std::memcpy(to.At(y, panel) + first * kPanelPx, from.At(y, panel), from.PanelStride() * sizeof(float));
  });
}

Panels UnshuffledImage(const cv::Mat& image, int u, int multiple_px, Workspace& workspace) {
  const cv::Size padded(RoundedUp(image.cols, multiple_px), RoundedUp(image.rows, multiple_px));
  Panels to(3 * u * u, padded / u, workspace);
  tbb::parallel_for(0, to.Size().height, [&](int y) {
    for (int j = 0; j < u; ++j) {
      const cv::Vec3f* from = image.ptr<cv::Vec3f>(Reflected(u * y + j, image.rows));
      for (int x = 0; x < padded.width; ++x) {
        const cv::Vec3f& px = from[x < image.cols ? x : Reflected(x, image.cols)];
        float* at = to.At(y, 0) + PlaceOf(to, static_cast<size_t>(x / u)) + (u * j + x % u) * kPanelPx;
        for (int c = 0; c < 3; ++c) at[c * u * u * kPanelPx] = px[c];
      }
    }
  });
  return to;
}

cv::Mat ChangedImage(const cv::Mat& image, const Panels& change, int u) {
  cv::Mat changed(image.size(), CV_32FC3);
  tbb::parallel_for(0, image.rows, [&](int y) {
    const cv::Vec3f* from = image.ptr<cv::Vec3f>(y);
    cv::Vec3f* to = changed.ptr<cv::Vec3f>(y);
    for (int x = 0; x < image.cols; ++x) {
      const float* at = change.At(y / u, 0) + PlaceOf(change, static_cast<size_t>(x / u)) +
                        (u * (y % u) + x % u) * kPanelPx;
      for (int c = 0; c < 3; ++c) to[x][c] = from[x][c] + at[c * u * u * kPanelPx];
    }
  });
  return changed;
}

}  // namespace shimmer::restore
