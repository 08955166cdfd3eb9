// WarpRow of sim/warp.h: every interpolation is sixteen samples with the weights of two axes.
#include <algorithm>
#include <cstring>

#include "sim/warp.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/warp_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/samples-inl.h"

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kBlock = 64;  // pixels at a time: their places and weights, their sums, then their planes

// Whole pixels and weights of a block along one axis. Of y, four planes of kBlock weights; of x, the four of
// a pixel together. RepeatEach reads up to three floats on.
struct Places {
  alignas(64) int32_t whole[kBlock];
  alignas(64) float weights[4 * kBlock + 4];
};

// The vectors that a pixel's sixteen samples fill: one of 16, two of 8 or four of 4.
using Sixteenth = hn::CappedTag<float, 16>;

// Weights of the four neighbours, t the fraction of a place in [0, 1).
template <Interpolation interpolation, class D, class V = hn::Vec<D>>
HWY_INLINE void WeightsOf(D d, V t, V& w0, V& w1, V& w2, V& w3) {
  const auto c = [&](float v) HWY_ATTR { return hn::Set(d, v); };
  if constexpr (interpolation == Interpolation::kBicubic) {
    const V t2 = hn::Mul(t, t), half_t = hn::Mul(t, c(0.5f)), half_t2 = hn::Mul(t2, c(0.5f));
    w0 = hn::Mul(half_t, hn::Sub(hn::Mul(hn::Sub(c(2), t), t), c(1)));
    w1 = hn::Add(hn::Mul(half_t2, hn::Sub(hn::Mul(t, c(3)), c(5))), c(1));
    w2 = hn::Mul(half_t, hn::Add(hn::Mul(hn::Sub(c(4), hn::Mul(t, c(3))), t), c(1)));
    w3 = hn::Mul(half_t2, hn::Sub(t, c(1)));
  } else {
    constexpr bool kNearest = interpolation == Interpolation::kNearest;
    w0 = w3 = hn::Zero(d);
    w2 = kNearest ? hn::IfThenElseZero(hn::Ge(t, c(0.5f)), c(1)) : t;
    w1 = hn::Sub(c(1), w2);
  }
}

template <Interpolation interpolation, bool kByPixel>
void FindPlaces(const float* shifts, size_t count, Places& places) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  float padded[kBlock];
  if (count < kBlock) {
    std::fill(std::copy_n(shifts, count, padded), padded + kBlock, 0.0f);
    shifts = padded;
  }
  for (size_t i = 0; i < kBlock; i += hn::Lanes(d)) {
    const auto shift = hn::LoadU(d, shifts + i), whole = hn::Floor(shift);
    auto w0 = shift, w1 = shift, w2 = shift, w3 = shift;
    WeightsOf<interpolation>(d, hn::Sub(shift, whole), w0, w1, w2, w3);
    hn::Store(hn::ConvertTo(di, whole), di, places.whole + i);
    float* to = places.weights + (kByPixel ? 4 * i : i);
    if constexpr (kByPixel) {
      hn::StoreInterleaved4(w0, w1, w2, w3, d, to);
    } else {
      hn::Store(w0, d, to);
      hn::Store(w1, d, to + kBlock);
      hn::Store(w2, d, to + 2 * kBlock);
      hn::Store(w3, d, to + 3 * kBlock);
    }
  }
}

// How a row's places are found, chosen once for all of it.
struct Finder {
  void (*x)(const float* shifts, size_t count, Places& places);
  void (*y)(const float* shifts, size_t count, Places& places);
};

template <Interpolation interpolation>
constexpr Finder kFinder = {FindPlaces<interpolation, true>, FindPlaces<interpolation, false>};

Finder FinderOf(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::kNearest:
      return kFinder<Interpolation::kNearest>;
    case Interpolation::kBilinear:
      return kFinder<Interpolation::kBilinear>;
    default:
      return kFinder<Interpolation::kBicubic>;
  }
}

// Lane i = values[i / 4].
template <class D>
HWY_INLINE hn::Vec<D> RepeatEach(D d, const float* values) {
  if constexpr (hn::MaxLanes(d) == 4) {
    return hn::Set(d, *values);
  } else {
    const hn::RebindToSigned<D> di;
    return hn::TableLookupLanes(hn::LoadDup128(d, values),
                                hn::IndicesFromVec(d, hn::ShiftRight<2>(hn::Iota(di, 0))));
  }
}

// The sum over four rows, in a fixed order.
template <class D, class T, class V = hn::Vec<D>>
HWY_INLINE V MixRows(D d, V w0, V w1, V w2, V w3, const T* r0, const T* r1, const T* r2, const T* r3) {
  return hn::Add(hn::Add(hn::Mul(w0, LoadSamples(d, r0)), hn::Mul(w1, LoadSamples(d, r1))),
                 hn::Add(hn::Mul(w2, LoadSamples(d, r2)), hn::Mul(w3, LoadSamples(d, r3))));
}

// The sum of four columns, in the order of ColumnSum below: upper half onto lower, until four lanes are left.
template <class D>
HWY_INLINE hn::Vec<hn::FixedTag<float, 4>> FoldToFour(D d, hn::Vec<D> v) {
  if constexpr (hn::MaxLanes(d) == 4) {
    return v;
  } else {
    const hn::Half<D> half;
    return FoldToFour(half, hn::Add(hn::LowerHalf(half, v), hn::UpperHalf(half, v)));
  }
}

template <class V>
HWY_INLINE V ColumnSum(V c0, V c1, V c2, V c3) {
  return hn::Add(hn::Add(c0, c2), hn::Add(c1, c3));
}

// Where the sixteen pixels around a place begin.
template <class T, int kStride>
HWY_INLINE const T* CornerOf(const cv::Mat& source, cv::Point first, const Places& x, const Places& y,
                             size_t i) {
  return reinterpret_cast<const T*>(source.data +
                                    (first.y + y.whole[i] - 1) * static_cast<ptrdiff_t>(source.step[0])) +
         (first.x + static_cast<int>(i) + x.whole[i] - 1) * static_cast<ptrdiff_t>(kStride);
}

// sums: four channels a pixel.
template <class T>
HWY_INLINE void ColourSums(const cv::Mat& source, cv::Point first, const Places& x, const Places& y,
                           size_t count, float* sums) {
  const Sixteenth d;
  constexpr size_t kLanes = hn::MaxLanes(d);
  const size_t step = source.step1();
  for (size_t i = 0; i < count; ++i) {
    const T* corner = CornerOf<T, 4>(source, first, x, y, i);
    const auto weight = [&](size_t j) HWY_ATTR { return hn::Set(d, y.weights[j * kBlock + i]); };
    const auto w0 = weight(0), w1 = weight(1), w2 = weight(2), w3 = weight(3);
    const auto part = [&](size_t sample) HWY_ATTR {
      const T* from = corner + sample;
      return hn::Mul(RepeatEach(d, x.weights + 4 * i + sample / 4),
                     MixRows(d, w0, w1, w2, w3, from, from + step, from + 2 * step, from + 3 * step));
    };
    const hn::FixedTag<float, 4> four;
    if constexpr (kLanes == 16)
      hn::Store(FoldToFour(d, part(0)), four, sums + 4 * i);
    else if constexpr (kLanes == 8)
      hn::Store(FoldToFour(d, hn::Add(part(0), part(8))), four, sums + 4 * i);
    else
      hn::Store(ColumnSum(part(0), part(4), part(8), part(12)), four, sums + 4 * i);
  }
}

// sums: four columns a pixel. Four pixels' rows of four samples, gathered, are a vector of sixteen.
template <class T>
HWY_INLINE void GreySums(const cv::Mat& source, cv::Point first, const Places& x, const Places& y,
                         size_t count, float* sums) {
  alignas(64) T rows[4][4 * kBlock];
  const size_t step = source.step1();
  for (size_t i = 0; i < count; ++i) {
    const T* corner = CornerOf<T, 1>(source, first, x, y, i);
    for (size_t j = 0; j < 4; ++j) std::memcpy(rows[j] + 4 * i, corner + j * step, 4 * sizeof(T));
  }
  for (size_t j = 0; j < 4; ++j) std::fill(rows[j] + 4 * count, rows[j] + 4 * ((count + 3) / 4 * 4), T{0});
  const Sixteenth d;
  for (size_t i = 0; i < 4 * count; i += hn::MaxLanes(d)) {
    const auto weight = [&](size_t j) HWY_ATTR { return RepeatEach(d, y.weights + j * kBlock + i / 4); };
    hn::Store(
        hn::Mul(hn::Load(d, x.weights + i), MixRows(d, weight(0), weight(1), weight(2), weight(3),
                                                    rows[0] + i, rows[1] + i, rows[2] + i, rows[3] + i)),
        d, sums + i);
  }
}

// Block after block: places and weights, four sums a pixel, and the planes.
template <class T, size_t kPlanes>
HWY_INLINE void WarpRowOf(const cv::Mat& source, cv::Point first, std::span<const float> dx,
                          std::span<const float> dy, const Finder& find, float* const* planes) {
  const hn::ScalableTag<float> d;
  Places x, y;
  alignas(64) float sums[4 * kBlock] = {}, rest[kPlanes][kBlock];
  for (size_t begin = 0; begin < dx.size(); begin += kBlock) {
    const size_t count = std::min(kBlock, dx.size() - begin);
    find.x(dx.data() + begin, count, x);
    find.y(dy.data() + begin, count, y);
    const cv::Point here(first.x + static_cast<int>(begin), first.y);
    float* to[kPlanes];
    for (size_t c = 0; c < kPlanes; ++c) to[c] = count == kBlock ? planes[c] + begin : rest[c];
    if constexpr (kPlanes == 1)
      GreySums<T>(source, here, x, y, count, sums);
    else
      ColourSums<T>(source, here, x, y, count, sums);
    for (size_t i = 0; i < kBlock; i += hn::Lanes(d)) {
      auto s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0;
      hn::LoadInterleaved4(d, sums + 4 * i, s0, s1, s2, s3);
      if constexpr (kPlanes == 1) {
        hn::StoreU(ToUnit<T>(d, ColumnSum(s0, s1, s2, s3)), d, to[0] + i);
      } else {
        hn::StoreU(ToUnit<T>(d, s0), d, to[0] + i);
        hn::StoreU(ToUnit<T>(d, s1), d, to[1] + i);
        hn::StoreU(ToUnit<T>(d, s2), d, to[2] + i);
      }
    }
    if (count < kBlock)
      for (size_t c = 0; c < kPlanes; ++c) std::copy_n(rest[c], count, planes[c] + begin);
  }
}

void WarpRow(const cv::Mat& source, cv::Point first, std::span<const float> dx, std::span<const float> dy,
             Interpolation interpolation, float* const* planes) {
  const Finder find = FinderOf(interpolation);
  switch (source.type()) {
    case CV_8UC1:
      return WarpRowOf<uint8_t, 1>(source, first, dx, dy, find, planes);
    case CV_8UC4:
      return WarpRowOf<uint8_t, 3>(source, first, dx, dy, find, planes);
    case CV_16UC1:
      return WarpRowOf<uint16_t, 1>(source, first, dx, dy, find, planes);
    case CV_16UC4:
      return WarpRowOf<uint16_t, 3>(source, first, dx, dy, find, planes);
    case CV_32FC1:
      return WarpRowOf<float, 1>(source, first, dx, dy, find, planes);
    case CV_32FC4:
      return WarpRowOf<float, 3>(source, first, dx, dy, find, planes);
  }
  throw std::invalid_argument("a frame of type " + cv::typeToString(source.type()) +
                              " was not prepared for warping");
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::sim {

HWY_EXPORT(WarpRow);

void WarpRow(const cv::Mat& source, cv::Point first, std::span<const float> dx, std::span<const float> dy,
             Interpolation interpolation, float* const* planes) {
  HWY_DYNAMIC_DISPATCH(WarpRow)(source, first, dx, dy, interpolation, planes);
}

}  // namespace shimmer::sim
#endif
