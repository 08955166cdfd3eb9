#include "restore/panel_product.h"

#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "restore/panel_product.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace shimmer::restore::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, kPanelPx>;

// One vector of a row: its px of column 0 of the right-hand matrix, and where its products go.
struct Vector {
  const float* right;
  float* out;
  const float* add;
};

// The sums of some rows of a tile and of one vector or two stay in registers over all columns.
template <bool kTwo, size_t... kRows>
HWY_INLINE void MultiplyVectors(std::index_sequence<kRows...>, const float* HWY_RESTRICT left, size_t columns,
                                const Vector& first, const Vector& second, size_t channel_stride) {
  const Tag d;
  using V = hn::Vec<Tag>;
  constexpr size_t kCount = sizeof...(kRows);
  V sums[kCount], more[kCount];
  ((sums[kRows] = more[kRows] = hn::Zero(d)), ...);
  const float *HWY_RESTRICT right = first.right, *HWY_RESTRICT right2 = second.right;
  for (size_t k = 0; k < columns; ++k) {
    const V values = hn::Load(d, right + k * kPanelPx);
    if constexpr (kTwo) {
      const V values2 = hn::Load(d, right2 + k * kPanelPx);
      const auto step = [&](size_t row, V& sum, V& sum2) HWY_ATTR {
        const V weight = hn::Set(d, left[row]);
        sum = hn::MulAdd(weight, values, sum);
        sum2 = hn::MulAdd(weight, values2, sum2);
      };
      (step(kRows, sums[kRows], more[kRows]), ...);
    } else {
      ((sums[kRows] = hn::MulAdd(hn::Set(d, left[kRows]), values, sums[kRows])), ...);
    }
    left += kCount;
  }
  const auto store = [&](const Vector& to, size_t row, V sum) HWY_ATTR {
    const size_t at = row * channel_stride;
    hn::Store(to.add ? hn::Add(sum, hn::Load(d, to.add + at)) : sum, d, to.out + at);
  };
  (store(first, kRows, sums[kRows]), ...);
  if constexpr (kTwo) (store(second, kRows, more[kRows]), ...);
}

template <size_t kRows>
void MultiplyTile(const float* left, size_t columns, const float* row, size_t begin, size_t end,
                  const RowPlace& out, const float* add) {
  constexpr size_t kLanes = hn::MaxLanes(Tag());
  constexpr auto rows = std::make_index_sequence<kRows>();
  const auto at = [&](size_t px) {
    const size_t panel = px / kPanelPx, lane = px % kPanelPx, place = panel * out.panel_stride + lane;
    return Vector{row + panel * columns * kPanelPx + lane, out.data + place, add ? add + place : nullptr};
  };
  size_t px = begin / kLanes * kLanes;
  for (; px + kLanes < end; px += 2 * kLanes)
    MultiplyVectors<true>(rows, left, columns, at(px), at(px + kLanes), out.channel_stride);
  if (px < end) MultiplyVectors<false>(rows, left, columns, at(px), at(px), out.channel_stride);
}

void Multiply(const PackedMatrix& matrix, const float* row, int begin, int end, const RowPlace& out,
              const float* add) {
  constexpr decltype(&MultiplyTile<1>) kBySize[] = {MultiplyTile<1>, MultiplyTile<2>, MultiplyTile<3>,
                                                    MultiplyTile<4>, MultiplyTile<5>, MultiplyTile<6>};
  static_assert(std::size(kBySize) == PackedMatrix::kMostTileRows);
  for (int tile = 0; tile < matrix.Tiles(); ++tile) {
    const int first = matrix.TileBegin(tile), rows = matrix.TileBegin(tile + 1) - first;
    const size_t skip = static_cast<size_t>(first) * out.channel_stride;
    kBySize[rows - 1](matrix.Tile(tile), static_cast<size_t>(matrix.Columns()), row,
                      static_cast<size_t>(begin), static_cast<size_t>(end),
                      {out.data + skip, out.panel_stride, out.channel_stride}, add ? add + skip : nullptr);
  }
}

}  // namespace shimmer::restore::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::restore {

PackedMatrix::PackedMatrix(const float* values, int rows, int columns, size_t row_stride,
                           size_t column_stride)
    : rows_(rows), columns_(columns) {
  values_.reserve(static_cast<size_t>(rows) * static_cast<size_t>(columns));
  for (int tile = 0; tile < Tiles(); ++tile)
    for (int column = 0; column < columns; ++column)
      for (int row = TileBegin(tile); row < TileBegin(tile + 1); ++row)
        values_.push_back(
            values[static_cast<size_t>(row) * row_stride + static_cast<size_t>(column) * column_stride]);
}

HWY_EXPORT(Multiply);

void Multiply(const PackedMatrix& matrix, const float* row, int begin, int end, const RowPlace& out,
              const float* add) {
  HWY_DYNAMIC_DISPATCH(Multiply)(matrix, row, begin, end, out, add);
}

}  // namespace shimmer::restore
#endif
