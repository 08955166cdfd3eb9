#include "sim/row_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/row_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void ConvolveRow(std::span<const float> weights, const float* centre, const float* const* before,
                 const float* const* after, std::span<float> out) {
  ForEachVector(out.size(), [&](auto d, size_t i) HWY_ATTR {
    auto sum = hn::Mul(hn::Set(d, weights[0]), hn::LoadU(d, centre + i));
    for (size_t k = 1; k < weights.size(); ++k) {
      const auto pair = hn::Add(hn::LoadU(d, before[k] + i), hn::LoadU(d, after[k] + i));
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[k]), pair));
    }
    hn::StoreU(sum, d, out.data() + i);
  });
}

void MixFourRows(std::span<const float, 4> weights, const float* const* rows, std::span<float> out) {
  ForEachVector(out.size(), [&](auto d, size_t i) HWY_ATTR {
    const auto term = [&](size_t k)
                          HWY_ATTR { return hn::Mul(hn::Set(d, weights[k]), hn::LoadU(d, rows[k] + i)); };
    hn::StoreU(hn::Add(hn::Add(term(0), term(1)), hn::Add(term(2), term(3))), d, out.data() + i);
  });
}

// Even points from three neighbours, odd ones from four, stored in turn.
template <class Even, class Odd>
HWY_INLINE void Interleave(const float* in, std::span<float> out, const Even& even, const Odd& odd) {
  ForEachVector(out.size() / 2, [&](auto d, size_t i) HWY_ATTR {
    const auto a = hn::LoadU(d, in + i), b = hn::LoadU(d, in + i + 1), c = hn::LoadU(d, in + i + 2),
               e = hn::LoadU(d, in + i + 3);
    if constexpr (hn::MaxLanes(d) == 1) {
      hn::StoreU(even(d, a, b, c), d, out.data() + 2 * i);
      hn::StoreU(odd(d, a, b, c, e), d, out.data() + 2 * i + 1);
    } else {
      hn::StoreInterleaved2(even(d, a, b, c), odd(d, a, b, c, e), d, out.data() + 2 * i);
    }
  });
}

void RefineSpline(const float* in, std::span<float> out) {
  Interleave(
      in, out,
      [](auto d, auto a, auto b, auto c) HWY_ATTR {  // (a + 6 b + c) / 8
        return hn::Add(hn::Mul(hn::Add(a, c), hn::Set(d, 0.125f)), hn::Mul(b, hn::Set(d, 0.75f)));
      },
      [](auto d, auto, auto b, auto c, auto) HWY_ATTR { return hn::Mul(hn::Add(b, c), hn::Set(d, 0.5f)); });
}

void EvaluateSpline(const float* in, std::span<float> out) {
  Interleave(
      in, out,
      [](auto d, auto a, auto b, auto c) HWY_ATTR {  // (a + 4 b + c) / 6
        return hn::Add(hn::Mul(hn::Add(a, c), hn::Set(d, 1.0f / 6)), hn::Mul(b, hn::Set(d, 2.0f / 3)));
      },
      [](auto d, auto a, auto b, auto c, auto e) HWY_ATTR {  // (a + 23 b + 23 c + e) / 48
        return hn::Add(hn::Mul(hn::Add(a, e), hn::Set(d, 1.0f / 48)),
                       hn::Mul(hn::Add(b, c), hn::Set(d, 23.0f / 48)));
      });
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::sim {

HWY_EXPORT(ConvolveRow);
HWY_EXPORT(MixFourRows);
HWY_EXPORT(RefineSpline);
HWY_EXPORT(EvaluateSpline);

void ConvolveRow(std::span<const float> weights, const float* centre, const float* const* before,
                 const float* const* after, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(ConvolveRow)(weights, centre, before, after, out);
}
void MixFourRows(std::span<const float, 4> weights, const float* const* rows, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(MixFourRows)(weights, rows, out);
}
void RefineSpline(const float* in, std::span<float> out) { HWY_DYNAMIC_DISPATCH(RefineSpline)(in, out); }
void EvaluateSpline(const float* in, std::span<float> out) { HWY_DYNAMIC_DISPATCH(EvaluateSpline)(in, out); }

}  // namespace shimmer::sim
#endif
