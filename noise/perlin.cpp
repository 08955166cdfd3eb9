#include "noise/perlin.h"

#include "noise/row_blocks.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "noise/perlin.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "noise/groups-inl.h"
#include "noise/tables-inl.h"

HWY_BEFORE_NAMESPACE();
namespace shimmer::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using WordTag = hn::ScalableTag<uint32_t>;
using ByteTag = hn::ScalableTag<uint8_t>;
using Floats = hn::Vec<FloatTag>;
using Words = hn::Vec<WordTag>;
using Bytes = hn::Vec<ByteTag>;

float Fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

// A row has one y and one z. Folding them and their fades into the gradients leaves, for each of the four
// edges along x that bound the row, gradient . p = slope x + rest by table, weights included.
struct Edge {
  FloatTable16 slope, rest;
};

struct GradientAxes {
  float along[3][16];
};

constexpr GradientAxes MakeGradientAxes() {
  GradientAxes axes{};
  for (size_t hash = 0; hash < 16; ++hash)
    for (size_t axis = 0; axis < 3; ++axis) axes.along[axis][hash] = kGradients[hash][axis];
  return axes;
}
constexpr GradientAxes kGradientAxes = MakeGradientAxes();

Edge MakeEdge(float y, float z, float weight) {
  const auto& [along_x, along_y, along_z] = kGradientAxes.along;
  float slope[16], rest[16];
  for (size_t hash = 0; hash < 16; ++hash) {
    slope[hash] = weight * along_x[hash];
    rest[hash] = weight * (along_y[hash] * y + along_z[hash] * z);
  }
  return {FloatTable16(slope), FloatTable16(rest)};
}

struct EdgeHashes {
  Words at[2][4];  // at the cell's two sides along x, on the four edges
};

HWY_INLINE EdgeHashes HashEdges(const ByteTable& hash, Bytes i, Bytes j, Bytes k) {
  const WordTag d;
  const Bytes one = hn::Set(ByteTag(), 1);
  EdgeHashes hashes;
  for (int side = 0; side < 2; ++side) {
    const Bytes hash_x = hn::Add(hash[side ? hn::Add(i, one) : i], j);
    for (int up = 0; up < 2; ++up) {
      const Bytes hash_xy = hn::Add(hash[up ? hn::Add(hash_x, one) : hash_x], k);
      hashes.at[side][up] = hn::BitCast(d, hash[hash_xy]);
      hashes.at[side][up + 2] = hn::BitCast(d, hash[hn::Add(hash_xy, one)]);
    }
  }
  return hashes;
}

// Noise of the points whose hashes are byte j of each lane.
template <int j>
HWY_INLINE Floats Interpolate(const EdgeHashes& hashes, const Edge (&edges)[4], Words cell) {
  const FloatTag d;
  const WordTag dw;
  const Words one_plus_x = hn::Or(hn::And(cell, hn::Set(dw, kFractionMask)), hn::Set(dw, kOneBits));
  const Floats x = hn::Sub(hn::BitCast(d, one_plus_x), hn::Set(d, 1.0f));
  const Floats x_from[2] = {x, hn::Sub(x, hn::Set(d, 1.0f))};
  Floats at[2];
  for (int side = 0; side < 2; ++side) {
    Floats slope = hn::Zero(d), rest = hn::Zero(d);
    for (int edge = 0; edge < 4; ++edge) {
      const Words index = hn::ShiftRight<8 * j>(hashes.at[side][edge]);
      slope = hn::Add(slope, edges[edge].slope[index]);
      rest = hn::Add(rest, edges[edge].rest[index]);
    }
    at[side] = hn::Add(hn::Mul(slope, x_from[side]), rest);
  }
  const Floats fade = hn::Mul(
      hn::Mul(hn::Mul(x, x), x),
      hn::Add(hn::Mul(x, hn::Sub(hn::Mul(x, hn::Set(d, 6.0f)), hn::Set(d, 15.0f))), hn::Set(d, 10.0f)));
  return hn::Add(at[0], hn::Mul(fade, hn::Sub(at[1], at[0])));
}

void AddPerlinRow(const Permutation& permutation, Fixed x, const PerlinStep& step, Fixed y, Fixed z,
                  float amplitude, int64_t x0, std::span<float> out) {
  const WordTag dw;
  const uint32_t y_cell = y.Cell8Fraction24(), z_cell = z.Cell8Fraction24();
  const auto fraction = [](uint32_t cell) { return static_cast<float>(cell & 0xffffff) * 0x1p-24f; };
  const float y0 = fraction(y_cell), y1 = y0 - 1, up = Fade(y0);
  const float z0 = fraction(z_cell), z1 = z0 - 1, deep = Fade(z0);
  const Edge edges[4] = {
      MakeEdge(y0, z0, (1 - up) * (1 - deep) * amplitude), MakeEdge(y1, z0, up * (1 - deep) * amplitude),
      MakeEdge(y0, z1, (1 - up) * deep * amplitude), MakeEdge(y1, z1, up * deep * amplitude)};
  const Bytes j = hn::Set(ByteTag(), static_cast<uint8_t>(y_cell >> 24)),
              k = hn::Set(ByteTag(), static_cast<uint8_t>(z_cell >> 24));
  const ByteTable hash(permutation.data());

  const auto start_of = [&](int64_t block) { return WordOf(x + step.x.step * block); };
  int64_t block = BlockOf(x0);
  uint32_t start = start_of(block);
  const GroupedRow row(x0, out);
  row.ForGroups([&](int64_t first) HWY_ATTR {
    Words cell[kParts];
    for (size_t part = 0; part < kParts; ++part) {
      const int64_t pixel = first + static_cast<int64_t>(part) * kPartPoints;
      if (BlockOf(pixel) != block) block = BlockOf(pixel), start = start_of(block);
      cell[part] = hn::Add(hn::Set(dw, start),
                           hn::Load(dw, step.x.offsets.data() + static_cast<size_t>(pixel - block)));
    }
    const EdgeHashes hashes = HashEdges(hash, TopBytes(cell), j, k);
    row.Add(first, [&]() HWY_ATTR { return Interpolate<0>(hashes, edges, cell[0]); });
    row.Add(first + kPartPoints, [&]() HWY_ATTR { return Interpolate<1>(hashes, edges, cell[1]); });
    row.Add(first + 2 * kPartPoints, [&]() HWY_ATTR { return Interpolate<2>(hashes, edges, cell[2]); });
    row.Add(first + 3 * kPartPoints, [&]() HWY_ATTR { return Interpolate<3>(hashes, edges, cell[3]); });
  });
}

}  // namespace shimmer::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::noise {

HWY_EXPORT(AddPerlinRow);

void AddPerlinRow(const Permutation& permutation, Fixed x, const PerlinStep& step, Fixed y, Fixed z,
                  float amplitude, int64_t x0, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(AddPerlinRow)(permutation, x, step, y, z, amplitude, x0, out);
}

}  // namespace shimmer::noise
#endif
