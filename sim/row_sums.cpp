#include "sim/row_sums.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/row_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kPartial = 16;

template <class F>
HWY_INLINE double Sum(std::span<const float> row, const F& f) {
  const hn::CappedTag<float, kPartial> d;
  const hn::CappedTag<float, 1> one;
  HWY_ALIGN float sums[kPartial] = {};
  size_t i = 0;
  for (; i + kPartial <= row.size(); i += kPartial)
    for (size_t j = 0; j < kPartial; j += hn::Lanes(d))
      hn::Store(hn::Add(hn::Load(d, sums + j), f(hn::LoadU(d, row.data() + i + j))), d, sums + j);
  for (size_t j = 0; i < row.size(); ++i, ++j)
    hn::Store(hn::Add(hn::Load(one, sums + j), f(hn::LoadU(one, row.data() + i))), one, sums + j);
  double sum = 0;
  for (const float partial : sums) sum += partial;
  return sum;
}

double SumOfRow(std::span<const float> row) {
  return Sum(row, [](auto v) HWY_ATTR { return v; });
}

double SumOfSquares(std::span<const float> row) {
  return Sum(row, [](auto v) HWY_ATTR { return hn::Mul(v, v); });
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::sim {

HWY_EXPORT(SumOfRow);
HWY_EXPORT(SumOfSquares);

double SumOfRow(std::span<const float> row) { return HWY_DYNAMIC_DISPATCH(SumOfRow)(row); }
double SumOfSquares(std::span<const float> row) { return HWY_DYNAMIC_DISPATCH(SumOfSquares)(row); }

}  // namespace shimmer::sim
#endif
