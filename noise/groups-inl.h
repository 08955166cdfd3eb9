// Groups: as many points of a row as a vector has bytes. Their lattice hashes are bytes, point j N + i in
// byte j of lane i (N lanes of 32 bits); their geometry is four vectors of floats, the j-th for byte j. A
// group begins at a multiple of N pixels and may lie in two blocks (noise/row_blocks.h), so that a short row
// that begins anywhere pays for few pixels but its own.
#if defined(SHIMMER_NOISE_GROUPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHIMMER_NOISE_GROUPS_INL_H_
#undef SHIMMER_NOISE_GROUPS_INL_H_
#else
#define SHIMMER_NOISE_GROUPS_INL_H_
#endif

#include <hwy/highway.h>
#include <algorithm>
#include <cstdint>
#include <span>

HWY_BEFORE_NAMESPACE();
namespace shimmer::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kParts = 4;
constexpr auto kPartPoints = static_cast<int64_t>(hn::MaxLanes(hn::ScalableTag<float>()));

// The top bytes of four vectors, one to each byte of a lane.
inline hn::Vec<hn::ScalableTag<uint8_t>> TopBytes(const hn::Vec<hn::ScalableTag<uint32_t>> (&part)[kParts]) {
  const hn::ScalableTag<uint32_t> d;
  using Words = hn::Vec<decltype(d)>;
  const Words a = hn::ShiftRight<24>(part[0]), b = hn::And(hn::ShiftRight<16>(part[1]), hn::Set(d, 0xff00u));
  const Words c = hn::And(hn::ShiftRight<8>(part[2]), hn::Set(d, 0xff0000u)),
              e = hn::And(part[3], hn::Set(d, 0xff000000u));
  return hn::BitCast(hn::ScalableTag<uint8_t>(), hn::Or(hn::Or(a, b), hn::Or(c, e)));
}

// Pixels x0 .. of a row, to which noise is added.
class GroupedRow {
 public:
  GroupedRow(int64_t x0, std::span<float> out)
      : x0_(x0), end_(x0 + static_cast<int64_t>(out.size())), out_(out.data()) {}

  // Calls f(first pixel) for each group that meets the row.
  template <class F>
  HWY_INLINE void ForGroups(const F& f) const {
    constexpr int64_t kGroupPoints = kPartPoints * kParts;
    for (int64_t first = x0_ & -kPartPoints; first < end_; first += kGroupPoints) f(first);
  }

  // Adds what value() says of pixels x, x + 1, ...; does not ask where none of them is in the row.
  template <class Value>
  HWY_INLINE void Add(int64_t x, const Value& value) const {
    const hn::ScalableTag<float> d;
    float* const to = out_ + (x - x0_);
    if (x >= x0_ && x + kPartPoints <= end_) {
      hn::StoreU(hn::Add(hn::LoadU(d, to), value()), d, to);
    } else if (x < end_) {
      alignas(64) float each[kPartPoints];
      hn::Store(value(), d, each);
      for (int64_t i = std::max(x, x0_) - x; i < std::min(kPartPoints, end_ - x); ++i) to[i] += each[i];
    }
  }

 private:
  int64_t x0_, end_;
  float* out_;
};

}  // namespace shimmer::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
