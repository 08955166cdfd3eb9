#include "sim/dataset/png_filter.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/dataset/png_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace shimmer::dataset::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Calls f(tag, i) for whole vectors of T that cover [0, count), the last one ending with it, so that some
// elements are done twice. Fewer than a vector go one by one.
template <class T, class F>
HWY_INLINE void CoverWithVectors(size_t count, const F& f) {
  const hn::ScalableTag<T> d;
  const size_t lanes = hn::Lanes(d);
  if (count < lanes) {
    const hn::CappedTag<T, 1> one;
    for (size_t i = 0; i < count; ++i) f(one, i);
    return;
  }
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) f(d, i);
  if (i < count) f(d, count - lanes);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Paeth([[maybe_unused]] D d, V left, V up, V corner) {
  const auto distance = [](V a, V b) HWY_ATTR { return hn::Sub(hn::Max(a, b), hn::Min(a, b)); };
  const auto at_most = [](V a, V b) HWY_ATTR { return hn::Eq(hn::Min(a, b), a); };
  // Of left + up - corner from left and from up; from the corner it is |(left - corner) + (up - corner)|: the
  // sum of the other two where both lie on one side of the corner, and more than either if it saturates.
  const V from_left = distance(up, corner), from_up = distance(left, corner);
  const auto on_two_sides = hn::Xor(at_most(corner, left), at_most(corner, up));
  const V from_corner =
      hn::IfThenElse(on_two_sides, distance(from_left, from_up), hn::SaturatedAdd(from_left, from_up));
  const auto left_is_nearest = hn::And(at_most(from_left, from_up), at_most(from_left, from_corner));
  return hn::IfThenElse(left_is_nearest, left, hn::IfThenElse(at_most(from_up, from_corner), up, corner));
}

void PaethRow(std::span<const uint8_t> row, const uint8_t* above, size_t pixel_bytes, uint8_t* out) {
  // The first pixel has nothing to its left: up is nearest.
  const size_t first = std::min(pixel_bytes, row.size());
  for (size_t i = 0; i < first; ++i) out[i] = static_cast<uint8_t>(row[i] - above[i]);
  const uint8_t* const at = row.data() + first;
  const uint8_t* const up = above + first;
  CoverWithVectors<uint8_t>(row.size() - first, [&](auto d, size_t i) HWY_ATTR {
    const auto nearest = Paeth(d, hn::LoadU(d, at + i - pixel_bytes), hn::LoadU(d, up + i),
                               hn::LoadU(d, up + i - pixel_bytes));
    hn::StoreU(hn::Sub(hn::LoadU(d, at + i), nearest), d, out + first + i);
  });
}

void BigEndianRow(std::span<const uint16_t> row, uint8_t* out) {
  CoverWithVectors<uint16_t>(row.size(), [&](auto d, size_t i) HWY_ATTR {
    const hn::Repartition<uint8_t, decltype(d)> bytes;
    const auto v = hn::LoadU(d, row.data() + i);
    hn::StoreU(hn::BitCast(bytes, hn::Or(hn::ShiftLeft<8>(v), hn::ShiftRight<8>(v))), bytes, out + 2 * i);
  });
}

}  // namespace shimmer::dataset::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::dataset {

HWY_EXPORT(PaethRow);
HWY_EXPORT(BigEndianRow);

void PaethRow(std::span<const uint8_t> row, const uint8_t* above, size_t pixel_bytes, uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(PaethRow)(row, above, pixel_bytes, out);
}
void BigEndianRow(std::span<const uint16_t> row, uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(BigEndianRow)(row, out);
}

}  // namespace shimmer::dataset
#endif
