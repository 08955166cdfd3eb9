#include "noise/spline_rows.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "noise/spline_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "noise/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace shimmer::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kPartPoints = 256;  // coefficients that are mixed at a time, so that they stay in the cache

void FilterSplineRow(const Rows<7>& rows, std::span<float> out) {
  ForEachVector(out.size(), [&](auto d, size_t i) HWY_ATTR {
    const auto pair = [&](size_t k, float weight) HWY_ATTR {
      return hn::Mul(hn::Set(d, weight), hn::Add(hn::LoadU(d, rows[k] + i), hn::LoadU(d, rows[6 - k] + i)));
    };
    const auto centre = hn::Mul(hn::Set(d, 344.0f / 216), hn::LoadU(d, rows[3] + i));
    const auto far = hn::Add(pair(0, -1.0f / 216), pair(1, 12.0f / 216));
    hn::StoreU(hn::Add(hn::Add(centre, pair(2, -75.0f / 216)), far), d, out.data() + i);
  });
}

void MixRows(const std::array<float, 4>& weights, const Rows<4>& rows, std::span<float> out) {
  ForEachVector(out.size(), [&](auto d, size_t i) HWY_ATTR {
    const auto term = [&](size_t k)
                          HWY_ATTR { return hn::Mul(hn::Set(d, weights[k]), hn::LoadU(d, rows[k] + i)); };
    hn::StoreU(hn::Add(hn::Add(term(0), term(1)), hn::Add(term(2), term(3))), d, out.data() + i);
  });
}

void AddRow(const float* row, std::span<float> out) {
  ForEachVector(out.size(), [&](auto d, size_t i) HWY_ATTR {
    float* to = out.data() + i;
    hn::StoreU(hn::Add(hn::LoadU(d, to), hn::LoadU(d, row + i)), d, to);
  });
}

// out[2 i] = even(i), out[2 i + 1] = odd(i), i < count
template <class Even, class Odd>
HWY_INLINE void Interleave(size_t count, const Even& even, const Odd& odd, float* out) {
  ForEachVector(count, [&](auto d, size_t i) HWY_ATTR {
    if constexpr (hn::MaxLanes(d) == 1) {
      hn::StoreU(even(d, i), d, out + 2 * i);
      hn::StoreU(odd(d, i), d, out + 2 * i + 1);
    } else {
      hn::StoreInterleaved2(even(d, i), odd(d, i), d, out + 2 * i);
    }
  });
}

void AddRefinedSplineRow(const Rows<3>& rows, bool odd_row, std::span<float> out) {
  float mixed[kPartPoints + 2], refined[2 * kPartPoints];
  for (size_t done = 0; done < out.size(); done += 2 * kPartPoints) {
    const std::span<float> part = out.subspan(done, std::min(2 * kPartPoints, out.size() - done));
    const size_t count = part.size() / 2;
    ForEachVector(count + 2, [&](auto d, size_t i) HWY_ATTR {
      const size_t at = done / 2 + i;
      const auto b = hn::LoadU(d, rows[1] + at), c = hn::LoadU(d, rows[2] + at);
      const auto value = odd_row
                             ? hn::Mul(hn::Add(b, c), hn::Set(d, 0.5f))
                             : hn::Add(hn::Mul(hn::Add(hn::LoadU(d, rows[0] + at), c), hn::Set(d, 0.125f)),
                                       hn::Mul(b, hn::Set(d, 0.75f)));
      hn::StoreU(value, d, mixed + i);
    });
    const auto at = [&](auto d, size_t i) HWY_ATTR { return hn::LoadU(d, mixed + i); };
    Interleave(
        count,
        [&](auto d, size_t i) HWY_ATTR {
          return hn::Add(hn::Mul(hn::Add(at(d, i), at(d, i + 2)), hn::Set(d, 0.125f)),
                         hn::Mul(at(d, i + 1), hn::Set(d, 0.75f)));
        },
        [&](auto d, size_t i)
            HWY_ATTR { return hn::Mul(hn::Add(at(d, i + 1), at(d, i + 2)), hn::Set(d, 0.5f)); },
        refined);
    AddRow(refined, part);
  }
}

void EvaluateSplineRow(const Rows<4>& rows, bool odd_row, size_t skip, std::span<float> out) {
  float mixed[kPartPoints + 3], values[2 * kPartPoints];
  const float outer = odd_row ? 1.0f / 48 : 1.0f / 6, inner = odd_row ? 23.0f / 48 : 2.0f / 3;
  for (size_t done = 0; done < out.size();) {
    const std::span<float> part = out.subspan(done, std::min(2 * kPartPoints - skip, out.size() - done));
    const size_t first = (done + 1) / 2, count = (skip + part.size() + 1) / 2;
    ForEachVector(count + 3, [&](auto d, size_t i) HWY_ATTR {
      const auto row = [&](size_t k) HWY_ATTR { return hn::LoadU(d, rows[k] + first + i); };
      const auto far = odd_row ? row(3) : row(2);
      const auto near = odd_row ? hn::Add(row(1), row(2)) : row(1);
      hn::StoreU(hn::Add(hn::Mul(hn::Add(row(0), far), hn::Set(d, outer)), hn::Mul(near, hn::Set(d, inner))),
                 d, mixed + i);
    });
    const auto at = [&](auto d, size_t i) HWY_ATTR { return hn::LoadU(d, mixed + i); };
    const bool whole = part.size() == 2 * count;
    Interleave(
        count,
        [&](auto d, size_t i) HWY_ATTR {
          return hn::Add(hn::Mul(hn::Add(at(d, i), at(d, i + 2)), hn::Set(d, 1.0f / 6)),
                         hn::Mul(at(d, i + 1), hn::Set(d, 2.0f / 3)));
        },
        [&](auto d, size_t i) HWY_ATTR {
          return hn::Add(hn::Mul(hn::Add(at(d, i), at(d, i + 3)), hn::Set(d, 1.0f / 48)),
                         hn::Mul(hn::Add(at(d, i + 1), at(d, i + 2)), hn::Set(d, 23.0f / 48)));
        },
        whole ? part.data() : values);
    if (!whole) std::copy_n(values + skip, part.size(), part.data());
    done += part.size();
    skip = 0;  // the next part begins at an even point
  }
}

}  // namespace shimmer::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::noise {

HWY_EXPORT(FilterSplineRow);
HWY_EXPORT(AddRefinedSplineRow);
HWY_EXPORT(EvaluateSplineRow);
HWY_EXPORT(MixRows);
HWY_EXPORT(AddRow);

void FilterSplineRow(const Rows<7>& rows, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(FilterSplineRow)(rows, out);
}
void AddRefinedSplineRow(const Rows<3>& rows, bool odd_row, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(AddRefinedSplineRow)(rows, odd_row, out);
}
void EvaluateSplineRow(const Rows<4>& rows, bool odd_row, size_t skip, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(EvaluateSplineRow)(rows, odd_row, skip, out);
}
void MixRows(const std::array<float, 4>& weights, const Rows<4>& rows, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(MixRows)(weights, rows, out);
}
void AddRow(const float* row, std::span<float> out) { HWY_DYNAMIC_DISPATCH(AddRow)(row, out); }

}  // namespace shimmer::noise
#endif
