#include "restore/panel_rows.h"

#include <algorithm>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "restore/panel_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "restore/normal_share-inl.h"

HWY_BEFORE_NAMESPACE();
namespace shimmer::restore::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, kPanelPx>;
using V = hn::Vec<Tag>;
constexpr size_t kLanes = hn::MaxLanes(Tag());

// The sum of f(values of a channel) over channels, in four chains.
template <class F>
HWY_INLINE V SumChannels(const float* at, size_t channels, const F& f) {
  const Tag d;
  V s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0;
  const auto value = [&](size_t c) HWY_ATTR { return f(hn::Load(d, at + c * kPanelPx)); };
  size_t c = 0;
  for (; c + 4 <= channels; c += 4) {
    s0 = hn::Add(s0, value(c));
    s1 = hn::Add(s1, value(c + 1));
    s2 = hn::Add(s2, value(c + 2));
    s3 = hn::Add(s3, value(c + 3));
  }
  for (; c < channels; ++c) s0 = hn::Add(s0, value(c));
  return hn::Add(hn::Add(s0, s1), hn::Add(s2, s3));
}

void NormaliseRow(const float* row, int channels, int begin, int end, const NormWeights& norm, float* out) {
  const Tag d;
  const size_t count = static_cast<size_t>(channels);
  const V share = hn::Set(d, 1.0f / static_cast<float>(channels));
  for (size_t px = static_cast<size_t>(begin) / kLanes * kLanes; px < static_cast<size_t>(end);
       px += kLanes) {
    const size_t at = px / kPanelPx * count * kPanelPx + px % kPanelPx;
    const float* from = row + at;
    float* to = out + at;
    const V mean = hn::Mul(SumChannels(from, count, [](V v) HWY_ATTR { return v; }), share);
    const V variance = hn::Mul(SumChannels(from, count,
                                           [&](V v) HWY_ATTR {
                                             const V off = hn::Sub(v, mean);
                                             return hn::Mul(off, off);
                                           }),
                               share);
    const V scale = hn::Div(hn::Set(d, 1), hn::Sqrt(hn::Add(variance, hn::Set(d, 1e-5f))));
    for (size_t c = 0; c < count; ++c) {
      const V value = hn::Load(d, from + c * kPanelPx), weight = hn::Set(d, norm.weight[c]);
      const V scaled =
          norm.bias ? hn::MulAdd(hn::Mul(hn::Sub(value, mean), scale), weight, hn::Set(d, norm.bias[c]))
                    : hn::Mul(hn::Mul(value, scale), weight);
      hn::Store(scaled, d, to + c * kPanelPx);
    }
  }
}

// One plane's nine weights, and its convolution at px of three rows.
struct Kernel {
  V weights[9];

  explicit HWY_INLINE Kernel(const float* values) {
    for (size_t i = 0; i < 9; ++i) weights[i] = hn::Set(Tag(), values[i]);
  }
  HWY_INLINE V operator()(const float* above, const float* here, const float* below) const {
    const Tag d;
    const auto row = [&](const float* at, size_t i, V sum) HWY_ATTR {
      sum = hn::MulAdd(weights[i], hn::LoadU(d, at - 1), sum);
      sum = hn::MulAdd(weights[i + 1], hn::LoadU(d, at), sum);
      return hn::MulAdd(weights[i + 2], hn::LoadU(d, at + 1), sum);
    };
    return hn::Add(hn::Add(row(above, 0, hn::Zero(d)), row(here, 3, hn::Zero(d))),
                   row(below, 6, hn::Zero(d)));
  }
};

void DepthwiseRow(const ThreeRows& from, int first, int planes, const float* weights, size_t panels,
                  const RowPlace& out) {
  for (size_t plane = 0; plane < static_cast<size_t>(planes); ++plane) {
    const size_t start = plane * from.plane_stride + static_cast<size_t>(first);
    const float *above = from.rows[0] + start, *here = from.rows[1] + start, *below = from.rows[2] + start;
    const Kernel kernel(weights + 9 * plane);
    for (size_t px = 0; px < panels * kPanelPx; px += kLanes)
      hn::Store(kernel(above + px, here + px, below + px), Tag(),
                out.data + px / kPanelPx * out.panel_stride + plane * out.channel_stride + px % kPanelPx);
  }
}

// Both convolutions of a part of a row, and then the gate: all constants at once have no room in registers.
void GateRow(const ThreeRows& from, int first, int half, const float* weights, size_t panels, float* out) {
  const Tag d;
  constexpr size_t kPartPx = 16 * kPanelPx;
  alignas(64) float gates[kPartPx], values[kPartPx];
  const size_t planes = static_cast<size_t>(half);
  for (size_t plane = 0; plane < planes; ++plane)
    for (size_t begin = 0; begin < panels * kPanelPx; begin += kPartPx) {
      const size_t count = std::min(kPartPx, panels * kPanelPx - begin);
      const auto convolve = [&](size_t of, float* to) HWY_ATTR {
        const size_t start = of * from.plane_stride + static_cast<size_t>(first) + begin;
        const float *above = from.rows[0] + start, *here = from.rows[1] + start,
                    *below = from.rows[2] + start;
        const Kernel kernel(weights + 9 * of);
        for (size_t px = 0; px < count; px += kLanes)
          hn::Store(kernel(above + px, here + px, below + px), d, to + px);
      };
      convolve(plane, gates);
      convolve(plane + planes, values);
      for (size_t px = 0; px < count; px += kLanes) {
        const V gate = hn::Load(d, gates + px);
        hn::Store(hn::Mul(hn::Mul(gate, NormalShare(d, gate)), hn::Load(d, values + px)), d,
                  out + ((begin + px) / kPanelPx * planes + plane) * kPanelPx + px % kPanelPx);
      }
    }
}

// Products of three channels and four over all px stay in registers.
constexpr size_t kTileI = 3, kTileJ = 4;

template <size_t... kAll>
HWY_INLINE void ProductTile(std::index_sequence<kAll...>, const float* const* q, const float* const* k,
                            size_t count, float* out) {
  const Tag d;
  V sums[sizeof...(kAll)];
  ((sums[kAll] = hn::Zero(d)), ...);
  for (size_t px = 0; px < count; px += kLanes) {
    const V k0 = hn::Load(d, k[0] + px), k1 = hn::Load(d, k[1] + px), k2 = hn::Load(d, k[2] + px),
            k3 = hn::Load(d, k[3] + px);
    const V ks[kTileJ] = {k0, k1, k2, k3};
    const V qs[kTileI] = {hn::Load(d, q[0] + px), hn::Load(d, q[1] + px), hn::Load(d, q[2] + px)};
    ((sums[kAll] = hn::MulAdd(qs[kAll / kTileJ], ks[kAll % kTileJ], sums[kAll])), ...);
  }
  ((out[kAll] = hn::GetLane(hn::SumOfLanes(d, sums[kAll]))), ...);
}

void AddProducts(const float* q, const float* k, int channels, size_t count, double* products) {
  const size_t n = static_cast<size_t>(channels);
  for (size_t i = 0; i < n; i += kTileI)
    for (size_t j = 0; j < n; j += kTileJ) {
      const float *qs[kTileI], *ks[kTileJ];
      for (size_t a = 0; a < kTileI; ++a) qs[a] = q + std::min(i + a, n - 1) * count;
      for (size_t b = 0; b < kTileJ; ++b) ks[b] = k + std::min(j + b, n - 1) * count;
      float sums[kTileI * kTileJ];
      ProductTile(std::make_index_sequence<kTileI * kTileJ>(), qs, ks, count, sums);
      for (size_t a = 0; a < std::min(kTileI, n - i); ++a)
        for (size_t b = 0; b < std::min(kTileJ, n - j); ++b)
          products[(i + a) * n + j + b] += static_cast<double>(sums[a * kTileJ + b]);
    }
}

void AddSquares(const float* values, int channels, size_t count, double* squares) {
  const Tag d;
  for (size_t c = 0; c < static_cast<size_t>(channels); ++c) {
    V s0 = hn::Zero(d);
    for (size_t px = 0; px < count; px += kLanes) {
      const V value = hn::Load(d, values + c * count + px);
      s0 = hn::MulAdd(value, value, s0);
    }
    squares[c] += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, s0)));
  }
}

void NormalShares(std::span<const float> x, float* out) {
  const Tag d;
  const hn::CappedTag<float, 1> one;
  size_t i = 0;
  for (; i + kLanes <= x.size(); i += kLanes)
    hn::StoreU(NormalShare(d, hn::LoadU(d, x.data() + i)), d, out + i);
  for (; i < x.size(); ++i) hn::StoreU(NormalShare(one, hn::LoadU(one, x.data() + i)), one, out + i);
}

}  // namespace shimmer::restore::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::restore {

HWY_EXPORT(NormaliseRow);
HWY_EXPORT(DepthwiseRow);
HWY_EXPORT(GateRow);
HWY_EXPORT(AddProducts);
HWY_EXPORT(AddSquares);
HWY_EXPORT(NormalShares);

void NormaliseRow(const float* row, int channels, int begin, int end, const NormWeights& norm, float* out) {
  HWY_DYNAMIC_DISPATCH(NormaliseRow)(row, channels, begin, end, norm, out);
}
void DepthwiseRow(const ThreeRows& from, int first, int planes, const float* weights, size_t panels,
                  const RowPlace& out) {
  HWY_DYNAMIC_DISPATCH(DepthwiseRow)(from, first, planes, weights, panels, out);
}
void GateRow(const ThreeRows& from, int first, int half, const float* weights, size_t panels, float* out) {
  HWY_DYNAMIC_DISPATCH(GateRow)(from, first, half, weights, panels, out);
}
void AddProducts(const float* q, const float* k, int channels, size_t count, double* products) {
  HWY_DYNAMIC_DISPATCH(AddProducts)(q, k, channels, count, products);
}
void AddSquares(const float* values, int channels, size_t count, double* squares) {
  HWY_DYNAMIC_DISPATCH(AddSquares)(values, channels, count, squares);
}
void NormalShares(std::span<const float> x, float* out) { HWY_DYNAMIC_DISPATCH(NormalShares)(x, out); }

}  // namespace shimmer::restore
#endif
