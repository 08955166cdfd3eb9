#include "sim/bicubic.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/bicubic.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kBlock = 64;  // pixels at a time: first their places and weights, then one by one

struct Places {
  alignas(64) int32_t whole[kBlock];
  alignas(64) float weight[4][kBlock];
};

// Whole pixels and Catmull-Rom weights of shifts; beyond count, whatever the padding gives.
HWY_INLINE void FindPlaces(const float* shifts, Places& places) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  const auto c = [&](float v) HWY_ATTR { return hn::Set(d, v); };
  for (size_t i = 0; i < kBlock; i += hn::Lanes(d)) {
    const auto shift = hn::Load(d, shifts + i), whole = hn::Floor(shift), t = hn::Sub(shift, whole),
               t2 = hn::Mul(t, t);
    const auto half_t = hn::Mul(t, c(0.5f)), half_t2 = hn::Mul(t2, c(0.5f));
    hn::Store(hn::ConvertTo(di, whole), di, places.whole + i);
    hn::Store(hn::Mul(half_t, hn::Sub(hn::Mul(hn::Sub(c(2), t), t), c(1))), d, places.weight[0] + i);
    hn::Store(hn::Add(hn::Mul(half_t2, hn::Sub(hn::Mul(t, c(3)), c(5))), c(1)), d, places.weight[1] + i);
    hn::Store(hn::Mul(half_t, hn::Add(hn::Mul(hn::Sub(c(4), hn::Mul(t, c(3))), t), c(1))), d,
              places.weight[2] + i);
    hn::Store(hn::Mul(half_t2, hn::Sub(t, c(1))), d, places.weight[3] + i);
  }
}

// Where the sixteen pixels around a place begin.
template <int kChannels>
HWY_INLINE const float* CornerOf(const cv::Mat& frame, cv::Point first, const Places& x, const Places& y,
                                 size_t i) {
  return frame.ptr<float>(first.y + y.whole[i] - 1) +
         (first.x + static_cast<int>(i) + x.whole[i] - 1) * kChannels;
}

// A pixel's three channels, and the next one's first, are a vector of four.
HWY_INLINE void ColourPixels(const cv::Mat& frame, cv::Point first, const Places& x, const Places& y,
                             size_t count, float* out) {
  const hn::FixedTag<float, 4> d;
  for (size_t i = 0; i < count; ++i) {
    const float* row = CornerOf<3>(frame, first, x, y, i);
    auto sum = hn::Zero(d);
    for (size_t j = 0; j < 4; ++j, row += frame.step1()) {
      auto along = hn::Mul(hn::Set(d, x.weight[0][i]), hn::LoadU(d, row));
      for (size_t k = 1; k < 4; ++k)
        along = hn::Add(along, hn::Mul(hn::Set(d, x.weight[k][i]), hn::LoadU(d, row + 3 * k)));
      sum = hn::Add(sum, hn::Mul(hn::Set(d, y.weight[j][i]), along));
    }
    HWY_ALIGN float pixel[4];
    hn::Store(sum, d, pixel);
    std::copy_n(pixel, 3, out + 3 * i);
  }
}

// Four neighbours along a row are a vector of four.
HWY_INLINE void GreyPixels(const cv::Mat& frame, cv::Point first, const Places& x, const Places& y,
                           size_t count, float* out) {
  const hn::FixedTag<float, 4> d;
  for (size_t i = 0; i < count; ++i) {
    const float* row = CornerOf<1>(frame, first, x, y, i);
    auto down = hn::Mul(hn::Set(d, y.weight[0][i]), hn::LoadU(d, row));
    for (size_t j = 1; j < 4; ++j)
      down = hn::Add(down, hn::Mul(hn::Set(d, y.weight[j][i]), hn::LoadU(d, row + j * frame.step1())));
    HWY_ALIGN float four[4];
    hn::Store(down, d, four);
    out[i] = 0;
    for (size_t k = 0; k < 4; ++k) out[i] += x.weight[k][i] * four[k];
  }
}

void BicubicRow(const cv::Mat& frame, cv::Point first, std::span<const float> dx, std::span<const float> dy,
                float* out) {
  const int channels = frame.channels();
  Places x, y;
  for (size_t begin = 0; begin < dx.size(); begin += kBlock) {
    const size_t count = std::min(kBlock, dx.size() - begin);
    HWY_ALIGN float shifts[kBlock] = {};
    std::copy_n(dx.data() + begin, count, shifts);
    FindPlaces(shifts, x);
    std::copy_n(dy.data() + begin, count, shifts);
    FindPlaces(shifts, y);
    const cv::Point here(first.x + static_cast<int>(begin), first.y);
    if (channels == 1)
      GreyPixels(frame, here, x, y, count, out + begin);
    else
      ColourPixels(frame, here, x, y, count, out + begin * 3);
  }
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::sim {

HWY_EXPORT(BicubicRow);

void BicubicRow(const cv::Mat& frame, cv::Point first, std::span<const float> dx, std::span<const float> dy,
                float* out) {
  HWY_DYNAMIC_DISPATCH(BicubicRow)(frame, first, dx, dy, out);
}

}  // namespace shimmer::sim
#endif
