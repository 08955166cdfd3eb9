// What the fast blur does to rows of floats. Each element on its own, so that the same bits come out on every
// SIMD target and wherever a row begins. No alignment is asked for, and nothing beyond the stated elements is
// read or written.
#if defined(SHIMMER_SIM_ROW_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHIMMER_SIM_ROW_KERNELS_INL_H_
#undef SHIMMER_SIM_ROW_KERNELS_INL_H_
#else
#define SHIMMER_SIM_ROW_KERNELS_INL_H_
#endif

#include <hwy/highway.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

#include "sim/level_ladder.h"

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Calls f(tag, i) for whole vectors; the last one begins earlier, so that it ends with the row, and computes
// some elements again. Rows shorter than a vector go one by one.
template <class F>
HWY_INLINE void CoverWithVectors(size_t count, const F& f) {
  const hn::ScalableTag<float> d;
  const hn::CappedTag<float, 1> one;
  const size_t lanes = hn::Lanes(d);
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) f(d, i);
  if (i == count) return;
  if (count >= lanes)
    f(d, count - lanes);
  else
    for (; i < count; ++i) f(one, i);
}

// Every second float from `from` on.
template <class D>
HWY_INLINE hn::Vec<D> LoadEven(D d, const float* from) {
#if HWY_TARGET == HWY_SCALAR  // has no lanes to pick from
  return hn::LoadU(d, from);
#else
  if constexpr (hn::MaxLanes(d) == 1) {
    return hn::LoadU(d, from);
  } else {
    return hn::ConcatEven(d, hn::LoadU(d, from + hn::Lanes(d)), hn::LoadU(d, from));
  }
#endif
}

// Calls f(std::integral_constant<int, radius>).
template <int least = 0, class F>
HWY_INLINE void WithRadius(int radius, const F& f) {
  if constexpr (least < kMostKernelRadius) {
    if (radius > least) return WithRadius<least + 1>(radius, f);
  }
  f(std::integral_constant<int, least>());
}

// Half of a symmetric kernel, copied: rows that are written can't be thought to change it, and it stays in
// registers.
template <int radius>
struct HalfKernel {
  explicit HalfKernel(const float* weights) {
    for (int k = 0; k <= radius; ++k) weight[k] = weights[k];
  }
  float weight[radius + 1];
};

// The sum of a symmetric kernel at an element: w[0] at(0) + sum_k w[k] (at(-k) + at(k)).
template <int radius, class D, class At>
HWY_INLINE hn::Vec<D> SymmetricSum(D d, const HalfKernel<radius>& kernel, const At& at) {
  hn::Vec<D> sum = hn::Mul(hn::Set(d, kernel.weight[0]), at(0));
  HWY_UNROLL(kMostKernelRadius)
  for (int k = 1; k <= radius; ++k)
    sum = hn::Add(sum, hn::Mul(hn::Set(d, kernel.weight[k]), hn::Add(at(-k), at(k))));
  return sum;
}

// A symmetric kernel down the columns: rows[radius + k] is the row k below the centre.
template <int radius>
HWY_INLINE void ConvolveDown(const HalfKernel<radius>& kernel, const float* const* rows,
                             std::span<float> out) {
  CoverWithVectors(
      out.size(), [&](auto d, size_t i) HWY_ATTR __attribute__((always_inline)) {
        const auto at = [&](int k) HWY_ATTR __attribute__((always_inline)) {
          return hn::LoadU(d, rows[radius + k] + i);
        };
        hn::StoreU(SymmetricSum<radius>(d, kernel, at), d, out.data() + i);
      });
}

// out[i] = sum_k w[k] rows[k][i], of four rows.
HWY_INLINE void MixFourRows(const std::array<float, 4>& weights, const float* const* rows,
                            std::span<float> out) {
  const std::array<float, 4> w = weights;  // nor can these be changed
  CoverWithVectors(
      out.size(), [&](auto d, size_t i) HWY_ATTR __attribute__((always_inline)) {
        const auto term = [&](size_t k) HWY_ATTR __attribute__((always_inline)) {
          return hn::Mul(hn::Set(d, w[k]), hn::LoadU(d, rows[k] + i));
        };
        hn::StoreU(hn::Add(hn::Add(term(0), term(1)), hn::Add(term(2), term(3))), d, out.data() + i);
      });
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
