#include "sim/pack_rows.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/pack_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/samples-inl.h"

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
constexpr size_t kLanes = hn::MaxLanes(Floats());

// Calls f(i) for whole vectors and rest(i, count) for what is left.
template <class F, class Rest>
HWY_INLINE void ForEachVectorAndRest(size_t width, const F& f, const Rest& rest) {
  size_t i = 0;
  for (; i + kLanes <= width; i += kLanes) f(i);
  if (i < width) rest(i, width - i);
}

template <class T, size_t kChannels>
HWY_INLINE void UnpackVector(const T* from, float* const (&to)[kChannels]) {
  const Floats d;
  if constexpr (kChannels == 1) {
    hn::StoreU(ToUnit<T>(d, LoadSamples(d, from)), d, to[0]);
  } else {
    const hn::Rebind<T, Floats> dt;
    auto s0 = hn::Zero(dt), s1 = s0, s2 = s0;
    hn::LoadInterleaved3(dt, from, s0, s1, s2);
    hn::StoreU(ToUnit<T>(d, ToFloats(d, s0)), d, to[0]);
    hn::StoreU(ToUnit<T>(d, ToFloats(d, s1)), d, to[1]);
    hn::StoreU(ToUnit<T>(d, ToFloats(d, s2)), d, to[2]);
  }
}

template <class T, size_t kChannels>
HWY_INLINE void UnpackRowOf(const cv::Mat& frame, cv::Point first, size_t width, float* const* planes) {
  const T* from = frame.ptr<T>(first.y) + first.x * static_cast<ptrdiff_t>(kChannels);
  const auto whole = [&](size_t i) HWY_ATTR {
    float* to[kChannels];
    for (size_t c = 0; c < kChannels; ++c) to[c] = planes[c] + i;
    UnpackVector<T, kChannels>(from + kChannels * i, to);
  };
  ForEachVectorAndRest(width, whole, [&](size_t i, size_t count) HWY_ATTR {
    T samples[kChannels * kLanes] = {};
    std::copy_n(from + kChannels * i, kChannels * count, samples);
    float rest[kChannels][kLanes];
    float* to[kChannels];
    for (size_t c = 0; c < kChannels; ++c) to[c] = rest[c];
    UnpackVector<T, kChannels>(samples, to);
    for (size_t c = 0; c < kChannels; ++c) std::copy_n(rest[c], count, planes[c] + i);
  });
}

void UnpackRow(const cv::Mat& frame, cv::Point first, size_t width, float* const* planes) {
  switch (frame.type()) {
    case CV_8UC1:
      return UnpackRowOf<uint8_t, 1>(frame, first, width, planes);
    case CV_8UC3:
      return UnpackRowOf<uint8_t, 3>(frame, first, width, planes);
    case CV_16UC1:
      return UnpackRowOf<uint16_t, 1>(frame, first, width, planes);
    case CV_16UC3:
      return UnpackRowOf<uint16_t, 3>(frame, first, width, planes);
    case CV_32FC1:
      return UnpackRowOf<float, 1>(frame, first, width, planes);
    case CV_32FC3:
      return UnpackRowOf<float, 3>(frame, first, width, planes);
  }
  throw std::invalid_argument("frame of type " + cv::typeToString(frame.type()) +
                              ", must be of 8 bits, 16 bits or float, 1 or 3 channels");
}

// v in [0, 1] times the largest T, rounded. The product in double is exact, and adding 2^52 rounds it to a
// whole number, ties to even, that the low bits then hold.
template <class T, class D>
HWY_INLINE hn::Vec<hn::Rebind<T, D>> RoundedProduct(D, hn::Vec<D> v) {
  const hn::Half<D> half;
  const hn::RepartitionToWide<D> wide;
  const auto round = [&](auto part) HWY_ATTR {
    const auto product = hn::Mul(hn::PromoteTo(wide, part), hn::Set(wide, std::numeric_limits<T>::max()));
    const auto sum = hn::Add(product, hn::Set(wide, 0x1p52));
    return hn::TruncateTo(hn::Rebind<T, decltype(half)>(),
                          hn::BitCast(hn::RebindToUnsigned<decltype(wide)>(), sum));
  };
  return hn::Combine(hn::Rebind<T, D>(), round(hn::UpperHalf(half, v)), round(hn::LowerHalf(half, v)));
}

template <class T, class D>
HWY_INLINE hn::Vec<hn::Rebind<T, D>> ToSamples([[maybe_unused]] D d, hn::Vec<D> v) {
  if constexpr (std::is_same_v<T, float>) {
    return v;
  } else {
    const auto zero_if_nan = hn::IfThenElseZero(hn::Gt(v, hn::Zero(d)), v);
    return RoundedProduct<T>(d, hn::Min(zero_if_nan, hn::Set(d, 1.0f)));
  }
}

template <class T, size_t kPlanes, size_t kChannels>
HWY_INLINE void PackVector(const float* const (&from)[kPlanes], T* to) {
  const Floats d;
  const hn::Rebind<T, Floats> dt;
  const auto first = ToSamples<T>(d, hn::LoadU(d, from[0]));
  if constexpr (kChannels == 1)
    hn::StoreU(first, dt, to);
  else if constexpr (kPlanes == 1)
    hn::StoreInterleaved3(first, first, first, dt, to);
  else
    hn::StoreInterleaved3(first, ToSamples<T>(d, hn::LoadU(d, from[1])),
                          ToSamples<T>(d, hn::LoadU(d, from[2])), dt, to);
}

template <class T, size_t kPlanes, size_t kChannels>
HWY_INLINE void PackRowOf(const float* const* planes, size_t width, T* to) {
  const auto whole = [&](size_t i) HWY_ATTR {
    const float* from[kPlanes];
    for (size_t c = 0; c < kPlanes; ++c) from[c] = planes[c] + i;
    PackVector<T, kPlanes, kChannels>(from, to + kChannels * i);
  };
  ForEachVectorAndRest(width, whole, [&](size_t i, size_t count) HWY_ATTR {
    float rest[kPlanes][kLanes] = {};
    const float* from[kPlanes];
    for (size_t c = 0; c < kPlanes; ++c) {
      std::copy_n(planes[c] + i, count, rest[c]);
      from[c] = rest[c];
    }
    T samples[kChannels * kLanes];
    PackVector<T, kPlanes, kChannels>(from, samples);
    std::copy_n(samples, kChannels * count, to + kChannels * i);
  });
}

template <class T>
HWY_INLINE void PackRowTo(std::span<const float* const> planes, int channels, size_t width, T* to) {
  if (planes.size() == 1 && channels == 1) return PackRowOf<T, 1, 1>(planes.data(), width, to);
  if (planes.size() == 1 && channels == 3) return PackRowOf<T, 1, 3>(planes.data(), width, to);
  if (planes.size() == 3 && channels == 3) return PackRowOf<T, 3, 3>(planes.data(), width, to);
  throw std::invalid_argument(std::to_string(planes.size()) + " planes for " + std::to_string(channels) +
                              " channels, must be 1 for 1, 1 for 3 or 3 for 3");
}

void PackRow8(std::span<const float* const> planes, int channels, size_t width, uint8_t* to) {
  PackRowTo(planes, channels, width, to);
}
void PackRow16(std::span<const float* const> planes, int channels, size_t width, uint16_t* to) {
  PackRowTo(planes, channels, width, to);
}
void PackRowFloat(std::span<const float* const> planes, int channels, size_t width, float* to) {
  PackRowTo(planes, channels, width, to);
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::sim {

HWY_EXPORT(UnpackRow);
HWY_EXPORT(PackRow8);
HWY_EXPORT(PackRow16);
HWY_EXPORT(PackRowFloat);

void UnpackRow(const cv::Mat& frame, cv::Point first, size_t width, float* const* planes) {
  HWY_DYNAMIC_DISPATCH(UnpackRow)(frame, first, width, planes);
}
void PackRow(std::span<const float* const> planes, int channels, size_t width, uint8_t* to) {
  HWY_DYNAMIC_DISPATCH(PackRow8)(planes, channels, width, to);
}
void PackRow(std::span<const float* const> planes, int channels, size_t width, uint16_t* to) {
  HWY_DYNAMIC_DISPATCH(PackRow16)(planes, channels, width, to);
}
void PackRow(std::span<const float* const> planes, int channels, size_t width, float* to) {
  HWY_DYNAMIC_DISPATCH(PackRowFloat)(planes, channels, width, to);
}
void PackRow(std::span<const float* const> planes, size_t width, cv::Point first, cv::Mat& frame) {
  switch (frame.depth()) {
    case CV_8U:
      return PackRow(planes, frame.channels(), width, frame.ptr<uint8_t>(first.y, first.x));
    case CV_16U:
      return PackRow(planes, frame.channels(), width, frame.ptr<uint16_t>(first.y, first.x));
    case CV_32F:
      return PackRow(planes, frame.channels(), width, frame.ptr<float>(first.y, first.x));
    default:
      throw std::invalid_argument("PackRow: frame of type " + cv::typeToString(frame.type()));
  }
}

}  // namespace shimmer::sim
#endif
