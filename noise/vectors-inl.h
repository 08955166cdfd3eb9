// Rows of floats in whole vectors, and what is left of them one by one, by the same code.
#if defined(SHIMMER_NOISE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHIMMER_NOISE_VECTORS_INL_H_
#undef SHIMMER_NOISE_VECTORS_INL_H_
#else
#define SHIMMER_NOISE_VECTORS_INL_H_
#endif

#include <hwy/highway.h>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace shimmer::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Calls f(tag, i) for whole vectors from element i on, and for the elements that are left with a vector of
// one.
template <class F>
HWY_INLINE void ForEachVector(size_t count, const F& f) {
  const hn::ScalableTag<float> d;
  const hn::CappedTag<float, 1> one;
  size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) f(d, i);
  for (; i < count; ++i) f(one, i);
}

}  // namespace shimmer::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
