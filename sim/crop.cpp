#include "sim/crop.h"

#include <vector>

#include "sim/resample.h"

namespace shimmer::sim {
namespace {

// Index of each of n pixels from first on, in an image of `size` pixels that is reflected without end.
std::vector<int> Reflected(int first, int n, int size) {
  std::vector<int> indices(static_cast<size_t>(n));
  for (int i = 0; i < n; ++i) indices[i] = cv::borderInterpolate(first + i, size, cv::BORDER_REFLECT_101);
  return indices;
}

cv::Rect WithHalo(cv::Rect area, int halo_px) {
  return {area.x - halo_px, area.y - halo_px, area.width + 2 * halo_px, area.height + 2 * halo_px};
}

}  // namespace

cv::Mat CropWithHalo(const cv::Mat& image, cv::Rect area, int halo_px) {
  const cv::Rect wanted = WithHalo(area, halo_px);
  if ((wanted & cv::Rect({}, image.size())) == wanted) return image(wanted).clone();

  cv::Mat cut(wanted.size(), image.type());
  const std::vector<int> columns = Reflected(wanted.x, wanted.width, image.cols),
                         rows = Reflected(wanted.y, wanted.height, image.rows);
  const size_t pixel_bytes = image.elemSize();
  for (int y = 0; y < cut.rows; ++y) {
    const uchar* from = image.ptr(rows[y]);
    uchar* to = cut.ptr(y);
    for (int x = 0; x < cut.cols; ++x, to += pixel_bytes)
      std::copy_n(from + columns[x] * pixel_bytes, pixel_bytes, to);
  }
  return cut;
}

cv::Mat ResizedCropWithHalo(const cv::Mat& samples, cv::Size resized, cv::Rect area, int halo_px) {
  // What the halo lacks on one side is reflected from less far into the picture than it reaches on the other.
  const cv::Rect inside = WithHalo(area, halo_px) & cv::Rect({}, resized);
  return CropWithHalo(ResizedPart(samples, resized, inside), area - inside.tl(), halo_px);
}

}  // namespace shimmer::sim
