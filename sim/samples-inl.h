// Samples of a frame, 8 bits, 16 bits or float, in vectors of floats.
#if defined(SHIMMER_SIM_SAMPLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHIMMER_SIM_SAMPLES_INL_H_
#undef SHIMMER_SIM_SAMPLES_INL_H_
#else
#define SHIMMER_SIM_SAMPLES_INL_H_
#endif

#include <hwy/highway.h>
#include <limits>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Samples of type T (whole numbers as they are) as floats.
template <class D, class V>
HWY_INLINE hn::Vec<D> ToFloats([[maybe_unused]] D d, V samples) {
  if constexpr (std::is_same_v<hn::TFromV<V>, float>)
    return samples;
  else
    return hn::ConvertTo(d, hn::PromoteTo(hn::RebindToSigned<D>(), samples));
}

template <class D, class T>
HWY_INLINE hn::Vec<D> LoadSamples(D d, const T* from) {
  return ToFloats(d, hn::LoadU(hn::Rebind<T, D>(), from));
}

// v / top, top = 255 or 65535, as v / (top + 1) + v / (top (top + 1)): the first is exact, so the sum of a
// whole v is the float nearest to v / top, and no division is needed. Floats stay.
template <class T, class D>
HWY_INLINE hn::Vec<D> ToUnit([[maybe_unused]] D d, hn::Vec<D> v) {
  if constexpr (std::is_same_v<T, float>) {
    return v;
  } else {
    constexpr double kTop = std::numeric_limits<T>::max();
    return hn::Add(hn::Mul(v, hn::Set(d, static_cast<float>(1 / (kTop + 1)))),
                   hn::Mul(v, hn::Set(d, static_cast<float>(1 / (kTop * (kTop + 1))))));
  }
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
