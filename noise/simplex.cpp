#include "noise/simplex.h"

#include "noise/row_blocks.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "noise/simplex.cpp"
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

struct Codes {
  Words corner[4];
};

HWY_INLINE auto IsNegative(Bytes bytes) {
  const hn::RebindToSigned<ByteTag> d;
  return hn::RebindMask(ByteTag(), hn::Lt(hn::BitCast(d, bytes), hn::Zero(d)));
}

// A code says all of a corner's gradient . p but p itself. A gradient has one sign along each of two axes:
//   bit 7: the first is negative; bit 6: the second is; bit 5: the first axis is y, not x; bit 4: the second
//   is z, not y; bits 0-3: 8 + 3 (gradient . o), o the vector from a middle corner to corner 0, a whole
//   number.
struct CodeTables {
  alignas(16) uint8_t plain[16], first[3][16], last[3][16];
};

constexpr CodeTables MakeCodeTables() {
  CodeTables tables{};
  for (int g = 0; g < 12; ++g) {
    const float* gradient = kGradients[g];
    const int first_axis = g >= 8 ? 1 : 0, second_axis = g >= 4 ? 2 : 1;
    const int code = (gradient[first_axis] < 0 ? 0x80 : 0) | (gradient[second_axis] < 0 ? 0x40 : 0) |
                     (first_axis == 1 ? 0x20 : 0) | (second_axis == 2 ? 0x10 : 0);
    const int sum2 = static_cast<int>(gradient[0] + gradient[1] + gradient[2]) / 2;  // -1, 0 or 1
    tables.plain[g] = static_cast<uint8_t>(code | 8);
    for (int axis = 0; axis < 3; ++axis) {
      const int along = static_cast<int>(gradient[axis]);
      tables.first[axis][g] = static_cast<uint8_t>(code | (8 + sum2 - 3 * along));  // corner e: p - e + 1/6
      tables.last[axis][g] =
          static_cast<uint8_t>(code | (8 - 4 * sum2 + 3 * along));  // corner 1 - e: p - 1 + e + 1/3
    }
  }
  return tables;
}
constexpr CodeTables kCodeTables = MakeCodeTables();

struct Hashes {
  ByteTable hash, gradient;
};

HWY_INLINE Bytes Lookup16(const uint8_t (&table)[16], Bytes index) {
  return hn::TableLookupBytes(hn::LoadDup128(ByteTag(), table), index);
}

HWY_INLINE Words OnePlusFraction(Words coordinate) {
  const WordTag d;
  return hn::Or(hn::And(coordinate, hn::Set(d, kFractionMask)), hn::Set(d, kOneBits));
}

// The points of a group in skewed coordinates.
struct Points {
  Words u[kParts], v[kParts], w[kParts];     // words, as in noise/row_blocks.h
  Words fu[kParts], fv[kParts], fw[kParts];  // 1 + their fractions, floats: in the order of their bits
};

HWY_INLINE Codes HashCorners(const Hashes& t, const Points& p) {
  const ByteTag d;
  const WordTag dw;
  const auto &u = p.u, &v = p.v, &w = p.w;
  Words uv[kParts], vw[kParts], uw[kParts];
  for (size_t j = 0; j < kParts; ++j)
    uv[j] = hn::Sub(p.fu[j], p.fv[j]), vw[j] = hn::Sub(p.fv[j], p.fw[j]), uw[j] = hn::Sub(p.fu[j], p.fw[j]);
  const auto u_lt_v = IsNegative(TopBytes(uv)), v_lt_w = IsNegative(TopBytes(vw)),
             u_lt_w = IsNegative(TopBytes(uw));
  const auto u_first = hn::Not(hn::Or(u_lt_v, u_lt_w)), v_first = hn::AndNot(v_lt_w, u_lt_v),
             w_first = hn::And(u_lt_w, v_lt_w);
  const auto u_last = hn::And(u_lt_v, u_lt_w), v_last = hn::AndNot(u_lt_v, v_lt_w),
             w_last = hn::Not(hn::Or(u_lt_w, v_lt_w));

  const Bytes i = TopBytes(u), j = TopBytes(v), k = TopBytes(w), one = hn::Set(d, 1);
  const Bytes i1 = hn::Add(i, one), j1 = hn::Add(j, one);
  const Bytes hash_k = t.hash[k], hash_k1 = t.hash[hn::Add(k, one)];
  const auto gradient = [&](Bytes at_i, Bytes at_j, Bytes hash_z) {
    return t.gradient[hn::Add(at_i, t.hash[hn::Add(at_j, hash_z)])];
  };
  const Bytes g0 = gradient(i, j, hash_k);
  const Bytes g1 = gradient(hn::IfThenElse(u_first, i1, i), hn::IfThenElse(v_first, j1, j),
                            hn::IfThenElse(w_first, hash_k1, hash_k));
  const Bytes g2 = gradient(hn::IfThenElse(u_last, i, i1), hn::IfThenElse(v_last, j, j1),
                            hn::IfThenElse(w_last, hash_k, hash_k1));
  const Bytes g3 = gradient(i1, j1, hash_k1);

  const CodeTables& c = kCodeTables;
  const Bytes c1 =
      hn::IfThenElse(u_first, Lookup16(c.first[0], g1),
                     hn::IfThenElse(v_first, Lookup16(c.first[1], g1), Lookup16(c.first[2], g1)));
  const Bytes c2 = hn::IfThenElse(u_last, Lookup16(c.last[0], g2),
                                  hn::IfThenElse(v_last, Lookup16(c.last[1], g2), Lookup16(c.last[2], g2)));
  return {{hn::BitCast(dw, Lookup16(c.plain, g0)), hn::BitCast(dw, c1), hn::BitCast(dw, c2),
           hn::BitCast(dw, Lookup16(c.plain, g3))}};
}

HWY_INLINE Floats Flip(Floats value, Words sign_in_top_bit) {
  const WordTag d;
  return hn::BitCast(FloatTag(),
                     hn::Xor(hn::BitCast(d, value), hn::And(sign_in_top_bit, hn::Set(d, 0x80000000u))));
}

// gradient . (x, y, z) of byte j of the codes.
template <int j>
HWY_INLINE Floats Dot(Words code, Floats x, Floats y, Floats z) {
  const Floats first = IfBitThenElse<5 + 8 * j>(code, y, x), second = IfBitThenElse<4 + 8 * j>(code, z, y);
  return hn::Add(Flip(first, hn::ShiftLeft<24 - 8 * j>(code)),
                 Flip(second, hn::ShiftLeft<(25 - 8 * j > 0 ? 25 - 8 * j : 0)>(code)));
}

// The code's low nibble less 8, as a float: put below 2^4's leading bit.
template <int j>
HWY_INLINE Floats OffsetDot(Words code) {
  const WordTag d;
  const Words placed =
      j < 3 ? hn::ShiftLeft<(j < 3 ? 19 - 8 * j > 0 ? 19 - 8 * j : 0 : 0)>(code) : hn::ShiftRight<5>(code);
  const Words bits = hn::Or(hn::And(placed, hn::Set(d, 0x780000u)), hn::Set(d, 0x41800000u));
  return hn::Sub(hn::BitCast(FloatTag(), bits), hn::Set(FloatTag(), 24.0f));
}

HWY_INLINE Floats Reach4(Floats reach) {
  const Floats r = hn::Max(reach, hn::Zero(FloatTag())), r2 = hn::Mul(r, r);
  return hn::Mul(r2, r2);
}

template <int j>
HWY_INLINE Floats Geometry(const Codes& codes, const Points& points, Floats radius2) {
  const FloatTag d;
  const auto c = [&](float v) { return hn::Set(d, v); };
  // u, v and w are 1 too large, which the constants below take off; sum, u + v + w - 3/2, is exact
  const Floats u = hn::BitCast(d, points.fu[j]), v = hn::BitCast(d, points.fv[j]),
               w = hn::BitCast(d, points.fw[j]);
  const Floats sum = hn::Add(hn::Add(hn::Sub(u, c(4.5f)), v), w), half_sum = hn::Mul(sum, c(0.5f)),
               unskew = hn::Add(hn::Mul(sum, c(1.0f / 6)), c(1.25f));
  const Floats x = hn::Sub(u, unskew), y = hn::Sub(v, unskew), z = hn::Sub(w, unskew);
  const Floats most = hn::Max(hn::Max(u, v), w), least = hn::Min(hn::Min(u, v), w);

  // radius^2 - |p|^2 at the four corners: |p - o|^2 = |p|^2 - 2 p . o + |o|^2
  const Floats reach0 = hn::Sub(hn::Sub(hn::Sub(radius2, hn::Mul(x, x)), hn::Mul(y, y)), hn::Mul(z, z));
  const Floats reach1 = hn::Add(reach0, hn::Sub(hn::Add(hn::Add(most, most), c(-3.5f)), half_sum));
  const Floats reach2 = hn::Sub(reach0, hn::Sub(hn::Add(hn::Add(least, least), c(-2.5f)), sum));
  const Floats reach3 = hn::Add(reach0, half_sum);
  const Floats x3 = hn::Mul(x, c(3)), y3 = hn::Mul(y, c(3)), z3 = hn::Mul(z, c(3));
  const Floats dot0 = Dot<j>(codes.corner[0], x3, y3, z3);
  const Floats dot1 = hn::Add(Dot<j>(codes.corner[1], x3, y3, z3), OffsetDot<j>(codes.corner[1]));
  const Floats dot2 = hn::Add(Dot<j>(codes.corner[2], x3, y3, z3), OffsetDot<j>(codes.corner[2]));
  const Floats dot3 =
      Dot<j>(codes.corner[3], hn::Sub(x3, c(1.5f)), hn::Sub(y3, c(1.5f)), hn::Sub(z3, c(1.5f)));
  return hn::Add(hn::Add(hn::Mul(Reach4(reach0), dot0), hn::Mul(Reach4(reach1), dot1)),
                 hn::Add(hn::Mul(Reach4(reach2), dot2), hn::Mul(Reach4(reach3), dot3)));
}

void AddSimplexRow(const SimplexTable& table, SimplexKernel kernel, Fixed x, const SimplexStep& step, Fixed y,
                   Fixed z, float amplitude, int64_t x0, std::span<float> out) {
  const FloatTag d;
  const WordTag dw;
  const Fixed sum = x + y + z, skew = sum.Third();
  const Fixed u_at_pixel0 = x + skew, v_at_pixel0 = y + skew, w_at_pixel0 = z + skew;
  // What the thirds leave, in thirds of 2^-64 cell: with it a block's start is exact, so that where the
  // octave repeats after some pixels, its bits do
  const auto rest = static_cast<int64_t>((sum.bits() - (skew * 3).bits()));
  const Floats radius2 = hn::Set(d, static_cast<float>(kernel.radius2)),
               scale = hn::Set(d, static_cast<float>(kernel.scale) * amplitude / 3);
  const Hashes hashes{ByteTable(table.hash.data()), ByteTable(table.gradient.data())};

  struct Start {
    uint32_t u, v, w;
  };
  const auto start_of = [&](int64_t block) -> Start {
    const int64_t left = rest + step.rest * block;
    const Fixed carry = Fixed::FromBits(left / 3 - (left % 3 < 0)), along_v = step.v.step * block + carry;
    return {WordOf(u_at_pixel0 + step.u.step * block + carry), WordOf(v_at_pixel0 + along_v),
            WordOf(w_at_pixel0 + along_v)};
  };

  int64_t block = BlockOf(x0);
  Start start = start_of(block);
  const GroupedRow row(x0, out);
  row.ForGroups([&](int64_t first) HWY_ATTR {
    Points p;
    for (size_t j = 0; j < kParts; ++j) {
      const int64_t pixel = first + static_cast<int64_t>(j) * kPartPoints;
      if (BlockOf(pixel) != block) block = BlockOf(pixel), start = start_of(block);
      const auto i = static_cast<size_t>(pixel - block);
      const Words offset_v = hn::Load(dw, step.v.offsets.data() + i);
      p.u[j] = hn::Add(hn::Set(dw, start.u), hn::Load(dw, step.u.offsets.data() + i));
      p.v[j] = hn::Add(hn::Set(dw, start.v), offset_v), p.w[j] = hn::Add(hn::Set(dw, start.w), offset_v);
      p.fu[j] = OnePlusFraction(p.u[j]), p.fv[j] = OnePlusFraction(p.v[j]);
      p.fw[j] = OnePlusFraction(p.w[j]);
    }
    const Codes codes = HashCorners(hashes, p);
    row.Add(first, [&]() HWY_ATTR { return hn::Mul(Geometry<0>(codes, p, radius2), scale); });
    row.Add(first + kPartPoints, [&]() HWY_ATTR { return hn::Mul(Geometry<1>(codes, p, radius2), scale); });
    row.Add(first + 2 * kPartPoints,
            [&]() HWY_ATTR { return hn::Mul(Geometry<2>(codes, p, radius2), scale); });
    row.Add(first + 3 * kPartPoints,
            [&]() HWY_ATTR { return hn::Mul(Geometry<3>(codes, p, radius2), scale); });
  });
}

}  // namespace shimmer::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::noise {

SimplexTable::SimplexTable(const Permutation& permutation) : hash(permutation) {
  for (size_t i = 0; i < hash.size(); ++i) gradient[i] = hash[i] % 12;
}

SimplexStep::SimplexStep(Fixed step_px)
    : u(step_px + step_px.Third()),
      v(step_px.Third()),
      rest(static_cast<int64_t>(step_px.bits() - (step_px.Third() * 3).bits())) {}

HWY_EXPORT(AddSimplexRow);

void AddSimplexRow(const SimplexTable& table, SimplexKernel kernel, Fixed x, const SimplexStep& step, Fixed y,
                   Fixed z, float amplitude, int64_t x0, std::span<float> out) {
  HWY_DYNAMIC_DISPATCH(AddSimplexRow)(table, kernel, x, step, y, z, amplitude, x0, out);
}

}  // namespace shimmer::noise
#endif
