// The two maps of sim/sigma_map.h over a row, in float32.
#include <algorithm>

#include "sim/sigma_map.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/sigma_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "noise/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using noise::HWY_NAMESPACE::ForEachVector;

// e^-x, x >= 0, absolute error below 1.5e-7; 0 from x = 87 on.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V ExpMinus(D d, V x) {
  const hn::RebindToSigned<D> di;
  // x = n log 2 - r, |r| <= 0.35; log 2 in two parts, so that n times the first is exact
  const V n = hn::Floor(hn::Add(hn::Mul(x, hn::Set(d, 1.44269504f)), hn::Set(d, 0.5f)));
  const V r =
      hn::Sub(hn::Mul(n, hn::Set(d, 0.693359375f)), hn::Add(x, hn::Mul(n, hn::Set(d, 2.12194440e-4f))));
  V sum = hn::Set(d, 1.0f / 5040);  // Taylor: r^8 / 8! < 6e-9
  for (const float c : {1.0f / 720, 1.0f / 120, 1.0f / 24, 1.0f / 6, 0.5f, 1.0f, 1.0f})
    sum = hn::Add(hn::Mul(sum, r), hn::Set(d, c));
  const auto exponent = hn::ShiftLeft<23>(hn::Sub(hn::Set(di, 127), hn::ConvertTo(di, n)));
  return hn::IfThenElseZero(hn::Lt(x, hn::Set(d, 87.0f)), hn::Mul(sum, hn::BitCast(d, exponent)));
}

// Phi(x), absolute error below 2e-7: Abramowitz and Stegun, 7.1.26, for erfc.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V NormalCdf(D d, V x) {
  const V z = hn::Mul(hn::Abs(x), hn::Set(d, 0.70710678f));
  const V t = hn::Div(hn::Set(d, 1.0f), hn::Add(hn::Set(d, 1.0f), hn::Mul(z, hn::Set(d, 0.3275911f))));
  V sum = hn::Set(d, 1.061405429f);
  for (const float c : {-1.453152027f, 1.421413741f, -0.284496736f, 0.254829592f, 0.0f})
    sum = hn::Add(hn::Mul(sum, t), hn::Set(d, c));
  const V tail = hn::Mul(hn::Mul(sum, ExpMinus(d, hn::Mul(z, z))), hn::Set(d, 0.5f));
  return hn::IfThenElse(hn::Lt(x, hn::Zero(d)), tail, hn::Sub(hn::Set(d, 1.0f), tail));
}

template <class F>
HWY_INLINE void AddToEach(std::span<float> sigma, const F& f) {
  ForEachVector(sigma.size(), [&](auto d, size_t i) HWY_ATTR {
    float* to = sigma.data() + i;
    hn::StoreU(hn::Add(hn::LoadU(d, to), f(d, i)), d, to);
  });
}

void AddPerlinPart(std::span<const float> m, float scale_px, std::span<float> sigma) {
  AddToEach(sigma, [&](auto d, size_t i) HWY_ATTR {
    const auto x = hn::Mul(hn::LoadU(d, m.data() + i), hn::Set(d, static_cast<float>(1 / kPerlinRms)));
    return hn::Mul(NormalCdf(d, x), hn::Set(d, scale_px));
  });
}

void AddTiltPart(std::span<const float> dx, std::span<const float> dy, float per_px, float scale_px,
                 std::span<float> sigma) {
  AddToEach(sigma, [&](auto d, size_t i) HWY_ATTR {
    const auto x = hn::Mul(hn::LoadU(d, dx.data() + i), hn::Set(d, per_px)),
               y = hn::Mul(hn::LoadU(d, dy.data() + i), hn::Set(d, per_px));
    const auto half_square = hn::Mul(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Set(d, 0.5f));
    return hn::Mul(hn::Sub(hn::Set(d, 1.0f), ExpMinus(d, half_square)), hn::Set(d, scale_px));
  });
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::sim {

HWY_EXPORT(AddPerlinPart);
HWY_EXPORT(AddTiltPart);

void AddPerlinPart(std::span<const float> m, double scale_px, std::span<float> sigma) {
  HWY_DYNAMIC_DISPATCH(AddPerlinPart)(m, static_cast<float>(scale_px), sigma);
}

void AddTiltPart(std::span<const float> dx, std::span<const float> dy, double strength_px, double scale_px,
                 std::span<float> sigma) {
  // A strength below 1e-37 px has no inverse in float32, and nothing to show.
  const double per_px = std::min(1 / (kTiltRmsOfStrength * strength_px), 1e37);
  HWY_DYNAMIC_DISPATCH(AddTiltPart)(dx, dy, static_cast<float>(per_px), static_cast<float>(scale_px), sigma);
}

}  // namespace shimmer::sim
#endif
