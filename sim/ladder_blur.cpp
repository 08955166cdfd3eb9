#include "sim/ladder_blur.h"

#include <bit>
#include <cstring>

#include "sim/band_levels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/ladder_blur.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "noise/tables-inl.h"
#include "sim/row_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using noise::HWY_NAMESPACE::FloatTable16;

using FloatTag = hn::ScalableTag<float>;
using Floats = hn::Vec<FloatTag>;
using WordTag = hn::RebindToUnsigned<FloatTag>;

// Of a row of `count` columns x0, x0 + 1, ...: the part [begin, end) that lies within a plane. Columns beyond
// are like the outermost.
struct Inside {
  Inside(int columns, int x0, size_t count)
      : begin(static_cast<size_t>(std::clamp(-x0, 0, static_cast<int>(count) - 1))),
        end(static_cast<size_t>(std::clamp(columns - x0, 1, static_cast<int>(count)))),
        first_column(x0 + static_cast<int>(begin)) {}

  void GoOn(std::span<float> row) const {
    if (begin > 0) std::fill_n(row.data(), begin, row[begin]);
    if (end < row.size()) std::fill_n(row.data() + end, row.size() - end, row[end - 1]);
  }

  size_t begin, end;
  int first_column;
};

// sigma -> its mixture and t, and each block's levels.
HWY_INLINE void FindMixtures(const MixtureTables& tables, size_t count, BandScratch& scratch) {
  const FloatTag d;
  const WordTag dw;
  const hn::RebindToSigned<FloatTag> di;
  const FloatTable16 scale(tables.scale.data()), offset(tables.offset.data()), levels(tables.levels.data());
  for (size_t begin = 0; begin < count; begin += kBlockPx) {
    auto asked_for = hn::Zero(dw);
    for (size_t i = begin; i < std::min(count, begin + kBlockPx); i += hn::Lanes(d)) {
      const Floats sigma = hn::Load(d, scratch.sigma + i), variance = hn::Mul(sigma, sigma);
      const auto exponent = hn::ShiftRight<23>(hn::BitCast(di, variance));  // variance is not negative
      const auto index =
          hn::BitCast(dw, hn::Min(hn::Max(hn::Sub(exponent, hn::Set(di, kFirstExponent)), hn::Zero(di)),
                                  hn::Set(di, tables.mixtures - 1)));
      hn::Store(index, dw, scratch.mixture + i);
      hn::Store(hn::Add(hn::Mul(variance, scale[index]), offset[index]), d, scratch.place + i);
      asked_for = hn::Or(asked_for, hn::BitCast(dw, levels[index]));
    }
    alignas(64) uint32_t lanes[kMostLanes];
    hn::Store(asked_for, dw, lanes);
    uint32_t all = 0;
    for (size_t i = 0; i < hn::Lanes(d); ++i) all |= lanes[i];
    scratch.levels[begin / kBlockPx] = all;
  }
}

// A level's weight at element i of the stretch.
class LevelWeight {
 public:
  LevelWeight(const MixtureTables& tables, size_t level, const BandScratch& scratch)
      : scratch_(scratch),
        cubic_{FloatTable16(tables.weight[level][0].data()), FloatTable16(tables.weight[level][1].data()),
               FloatTable16(tables.weight[level][2].data()), FloatTable16(tables.weight[level][3].data())} {}

  HWY_INLINE Floats At(size_t i) const {
    const auto mixture = hn::Load(WordTag(), scratch_.mixture + i);
    const Floats t = hn::Load(FloatTag(), scratch_.place + i);
    Floats weight = cubic_[3][mixture];
    weight = hn::Add(hn::Mul(weight, t), cubic_[2][mixture]);
    weight = hn::Add(hn::Mul(weight, t), cubic_[1][mixture]);
    return hn::Add(hn::Mul(weight, t), cubic_[0][mixture]);
  }

 private:
  const BandScratch& scratch_;
  FloatTable16 cubic_[4];
};

HWY_INLINE void AddTo(float* sum, Floats value) {
  const FloatTag d;
  hn::Store(hn::Add(hn::Load(d, sum), value), d, sum);
}

// The frame's rows around a pixel's: row[channel][radius + k] is the one k below.
struct RowsAround {
  RowsAround(const BandLevels& band, int y) {
    for (size_t c = 0; c < band.frame.size(); ++c)
      for (int k = -band.most_radius; k <= band.most_radius; ++k)
        row[c][kMostKernelRadius + k] =
            band.frame[c].ptr<float>(std::clamp(y + k, 0, band.frame[c].rows - 1));
  }

  const float* row[3][2 * kMostKernelRadius + 1];
};

// Adds a fine level to elements [begin, end): its kernel down the columns, then along the row.
template <int channels, int radius>
HWY_INLINE void AddFine(const BandLevels& band, const HalfKernel<radius> kernel, const RowsAround& around,
                        int x, size_t begin, size_t end, const LevelWeight& weight, BandScratch& scratch) {
  const FloatTag d;
  const size_t wide = end - begin + 2 * radius;
  const Inside inside(band.frame[0].cols, x + static_cast<int>(begin) - radius, wide);
  for (int c = 0; c < channels; ++c) {
    const float* rows[2 * radius + 1];
    for (int k = 0; k <= 2 * radius; ++k)
      rows[k] = around.row[c][kMostKernelRadius - radius + k] + inside.first_column;
    ConvolveDown<radius>(kernel, rows, {scratch.down[c] + inside.begin, inside.end - inside.begin});
    inside.GoOn({scratch.down[c], wide});
  }
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const Floats w = weight.At(i);
    for (int c = 0; c < channels; ++c) {
      const float* from = scratch.down[c] + (i - begin) + radius;
      const auto along = [&](int k) HWY_ATTR __attribute__((always_inline)) {
        return hn::LoadU(d, from + k);
      };
      AddTo(scratch.sum[c] + i, hn::Mul(w, SymmetricSum<radius>(d, kernel, along)));
    }
  }
}

// Adds a coarse level to elements [begin, end), begin a multiple of all spacings: four rows of the grid mixed
// at its own width, then its spline along the row.
template <int channels>
HWY_INLINE void AddCoarse(const CoarseLevel& level, const SplinePhases& phases, cv::Point at, size_t begin,
                          size_t end, const LevelWeight& weight, BandScratch& scratch) {
  const FloatTag d;
  const hn::RebindToSigned<FloatTag> di;
  const size_t lanes = hn::Lanes(d);
  const int shift = std::countr_zero(static_cast<unsigned>(level.spacing_px)), spacing = 1 << shift;
  const int row = at.y >> shift, first_x = at.x + static_cast<int>(begin), column = first_x >> shift;
  const std::array<float, 4>& down = phases.down[static_cast<size_t>(at.y & (spacing - 1))];
  const size_t points = ((static_cast<size_t>(first_x & (spacing - 1)) + end - begin - 1) >> shift) + 4;
  const Inside inside(level.coefficients[0].cols, column - 1, points);
  for (int c = 0; c < channels; ++c) {
    const cv::Mat& grid = level.coefficients[c];
    const float* rows[4];
    for (int k = 0; k < 4; ++k)
      rows[k] = grid.ptr<float>(std::clamp(row - 1 + k, 0, grid.rows - 1)) + inside.first_column;
    MixFourRows(down, rows, {scratch.down[c] + inside.begin, inside.end - inside.begin});
    inside.GoOn({scratch.down[c], points});
  }
  const size_t period = std::max(lanes, static_cast<size_t>(spacing));
  for (size_t phase = 0; phase < period; phase += lanes) {
    const Floats along[4] = {hn::Load(d, phases.weight[0] + phase), hn::Load(d, phases.weight[1] + phase),
                             hn::Load(d, phases.weight[2] + phase), hn::Load(d, phases.weight[3] + phase)};
    const auto first = hn::Load(di, phases.point + phase);
    const int32_t from = phases.point[phase];
    const auto lane_of = [&](int k) HWY_ATTR __attribute__((always_inline)) {
      return hn::IndicesFromVec(d, hn::Add(hn::Sub(first, hn::Set(di, from)), hn::Set(di, k)));
    };
    // A vector of at least 8 holds all points that its own pixels need; shorter ones are loaded for each tap
    constexpr bool kOneLoad = hn::MaxLanes(FloatTag()) >= 8;
    const decltype(lane_of(0)) lane[4] = {lane_of(0), lane_of(kOneLoad ? 1 : 0), lane_of(kOneLoad ? 2 : 0),
                                          lane_of(kOneLoad ? 3 : 0)};
    for (size_t i = begin + phase; i < end; i += period) {
      const Floats w = weight.At(i);
      const size_t point = static_cast<size_t>(from) + ((i - phase - begin) >> shift);
      for (int c = 0; c < channels; ++c) {
        const float* from_point = scratch.down[c] + point;
        const Floats near = hn::LoadU(d, from_point);
        const auto tap = [&](int k) HWY_ATTR __attribute__((always_inline)) {
          const Floats points_here = kOneLoad ? near : hn::LoadU(d, from_point + k);
          return hn::Mul(along[k], hn::TableLookupLanes(points_here, lane[k]));
        };
        const Floats value = hn::Add(hn::Add(tap(0), tap(1)), hn::Add(tap(2), tap(3)));
        AddTo(scratch.sum[c] + i, hn::Mul(w, value));
      }
    }
  }
}

// A stretch of a row, count <= kStretchPx.
template <int channels>
HWY_INLINE void BlurStretch(const BandLevels& band, cv::Point at, const float* sigma_px, size_t count,
                            const std::array<SplinePhases, kSpacings>& phases, BandScratch& scratch) {
  const size_t padded = (count + hn::Lanes(FloatTag()) - 1) / hn::Lanes(FloatTag()) * hn::Lanes(FloatTag());
  std::copy(sigma_px, sigma_px + count, scratch.sigma);
  std::fill(scratch.sigma + count, scratch.sigma + padded, sigma_px[0]);
  FindMixtures(band.tables, padded, scratch);
  for (int c = 0; c < channels; ++c) std::fill_n(scratch.sum[c], padded, 0.0f);
  const RowsAround around(band, at.y);
  const size_t blocks = (padded + kBlockPx - 1) / kBlockPx;
  for (size_t k = 0; k < band.coarse.size(); ++k) {
    const LevelWeight weight(band.tables, k, scratch);
    const CoarseLevel& level = band.coarse[k];
    const auto asks = [&](size_t block) { return (scratch.levels[block] >> k & 1) != 0; };
    for (size_t block = 0; block < blocks; ++block) {
      if (!asks(block)) continue;
      const size_t begin = block * kBlockPx;
      while (block + 1 < blocks && asks(block + 1)) ++block;
      const size_t end = std::min(padded, (block + 1) * kBlockPx);
      if (level.spacing_px == 1) {
        WithRadius(band.kernels[k].radius, [&](auto radius) HWY_ATTR {
          AddFine<channels, radius>(band, HalfKernel<radius>(band.kernels[k].weight.data()), around, at.x,
                                    begin, end, weight, scratch);
        });
      } else {
        AddCoarse<channels>(level, phases[std::countr_zero(static_cast<unsigned>(level.spacing_px)) - 1], at,
                            begin, end, weight, scratch);
      }
    }
  }
}

void BlurBand(const BandLevels& band, cv::Point first, const cv::Mat& sigma_px, Planes& out) {
  BandScratch scratch;
  std::array<SplinePhases, kSpacings> phases;
  for (int s = 0; s < kSpacings; ++s) phases[s] = PhasesOf(first.x, 2 << s);
  for (int x = 0; x < sigma_px.cols; x += kStretchPx) {
    const auto count = static_cast<size_t>(std::min(kStretchPx, sigma_px.cols - x));
    for (int y = 0; y < sigma_px.rows; ++y) {
      const cv::Point at = first + cv::Point(x, y);
      if (out.size() == 1)
        BlurStretch<1>(band, at, sigma_px.ptr<float>(y) + x, count, phases, scratch);
      else
        BlurStretch<3>(band, at, sigma_px.ptr<float>(y) + x, count, phases, scratch);
      for (size_t c = 0; c < out.size(); ++c) std::copy_n(scratch.sum[c], count, out[c].ptr<float>(y) + x);
    }
  }
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::sim {

HWY_EXPORT(BlurBand);

LadderBlur::LadderBlur(const Planes& frame, const LevelLadder& ladder)
    : frame_(frame), tables_(ladder), coarse_(CoarseLevels(frame, ladder)) {
  for (const BlurLevel& level : ladder.levels()) {
    const bool fine = level.spacing_px == 1;
    FineKernel kernel;
    if (fine) kernel.radius = static_cast<int>(level.kernel.size()) - 1;
    if (fine) std::copy(level.kernel.begin(), level.kernel.end(), kernel.weight.begin());
    most_radius_ = std::max(most_radius_, kernel.radius);
    kernels_.push_back(kernel);
  }
}

void LadderBlur::Band(cv::Point first, const cv::Mat& sigma_px, Planes& out) const {
  HWY_DYNAMIC_DISPATCH(BlurBand)
  ({frame_, tables_, kernels_, most_radius_, coarse_}, first, sigma_px, out);
}

}  // namespace shimmer::sim
#endif
