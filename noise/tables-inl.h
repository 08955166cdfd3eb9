// Tables that live in vector registers, per SIMD target: the one place that knows which instructions look
// things up.
#if defined(SHIMMER_NOISE_TABLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHIMMER_NOISE_TABLES_INL_H_
#undef SHIMMER_NOISE_TABLES_INL_H_
#else
#define SHIMMER_NOISE_TABLES_INL_H_
#endif

#include <hwy/highway.h>
#include <algorithm>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace shimmer::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_AVX3_DL

// One instruction looks up 128 entries.
class ByteTable {
 public:
  using Bytes = hn::Vec<hn::ScalableTag<uint8_t>>;

  explicit ByteTable(const uint8_t* table) {
    const hn::ScalableTag<uint8_t> d;
    for (int i = 0; i < 4; ++i) quarters_[i] = hn::LoadU(d, table + 64 * i).raw;
  }

  Bytes operator[](Bytes index) const {
    const __m512i low = _mm512_permutex2var_epi8(quarters_[0], index.raw, quarters_[1]);
    const __m512i high = _mm512_permutex2var_epi8(quarters_[2], index.raw, quarters_[3]);
    return Bytes{_mm512_mask_blend_epi8(_mm512_movepi8_mask(index.raw), low, high)};
  }

 private:
  __m512i quarters_[4];
};

#else

// Two halves of eight tables of 16 entries, each looked up by the index's low nibble. Table k holds its
// difference (xor) from table k - 1; where it is not due, the index less 16 k is negative and looks up 0: all
// that are due add up to the right one. Indices of the other half are negative from the start, and stay so.
class ByteTable {
 public:
  using D = hn::ScalableTag<uint8_t>;
  using Bytes = hn::Vec<D>;

  explicit ByteTable(const uint8_t* table) {
    for (int half = 0; half < 2; ++half)
      for (int k = 0; k < 8; ++k)
        for (int i = 0; i < 16; ++i) {
          const int at = 128 * half + 16 * k + i;
          differences_[half][k][i] = static_cast<uint8_t>(table[at] ^ (k > 0 ? table[at - 16] : 0));
        }
  }

  Bytes operator[](Bytes index) const {
    const hn::RebindToSigned<D> ds;
    const auto sixteen = hn::Set(ds, 16);
    auto low = hn::BitCast(ds, index), high = hn::BitCast(ds, hn::Xor(index, hn::Set(D(), 0x80)));
    Bytes found = hn::Xor(LookupNibble(differences_[0][0], low), LookupNibble(differences_[1][0], high));
    for (int k = 1; k < 8; ++k) {
      low = hn::SaturatedSub(low, sixteen), high = hn::SaturatedSub(high, sixteen);
      found = hn::Xor(found,
                      hn::Xor(LookupNibble(differences_[0][k], low), LookupNibble(differences_[1][k], high)));
    }
    return found;
  }

 private:
  // Of the low nibble, or 0 for a negative index. x86 leaves the bits between alone; others want them gone.
  static Bytes LookupNibble(const uint8_t (&table)[16], hn::Vec<hn::RebindToSigned<D>> signed_index) {
    const D d;
    Bytes index = hn::BitCast(d, signed_index);
#if !HWY_ARCH_X86 || HWY_TARGET == HWY_EMU128
    index = hn::And(index, hn::Set(d, 0x8f));
#endif
    return hn::TableLookupBytesOr0(hn::LoadDup128(d, table), index);
  }

  alignas(64) uint8_t differences_[2][8][16];
};

#endif

// yes where bit n of the word is set, else no. Where blending looks at a lane's top bit alone, the bit is put
// there. (Not on SSSE3, whose blending wants whole lanes and whose IfNegativeThenElse, in Highway 1.0.3,
// forgets to make them so.)
template <int n, class Words, class Floats>
Floats IfBitThenElse(Words word, Floats yes, Floats no) {
  const hn::ScalableTag<float> df;
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4
  return hn::IfNegativeThenElse(hn::BitCast(df, hn::ShiftLeft<31 - n>(word)), yes, no);
#else
  const hn::ScalableTag<uint32_t> d;
  return hn::IfThenElse(hn::RebindMask(df, hn::TestBit(word, hn::Set(d, 1u << n))), yes, no);
#endif
}

// A table of 16 floats, looked up by the low nibble of 32-bit lanes; what stands above the nibble does not
// matter.
class FloatTable16 {
 public:
  using D = hn::ScalableTag<float>;
  using Floats = hn::Vec<D>;
  using Words = hn::Vec<hn::RebindToUnsigned<D>>;

#if HWY_TARGET <= HWY_AVX3
  explicit FloatTable16(const float* table) : all_(_mm512_loadu_ps(table)) {}
  Floats operator[](Words index) const { return Floats{_mm512_permutexvar_ps(index.raw, all_)}; }

 private:
  __m512 all_;
#elif HWY_TARGET == HWY_AVX2
  explicit FloatTable16(const float* table)
      : low_(_mm256_loadu_ps(table)), high_(_mm256_loadu_ps(table + 8)) {}
  Floats operator[](Words index) const {
    const __m256 bit3_on_top = _mm256_castsi256_ps(_mm256_slli_epi32(index.raw, 28));
    return Floats{_mm256_blendv_ps(_mm256_permutevar8x32_ps(low_, index.raw),
                                   _mm256_permutevar8x32_ps(high_, index.raw), bit3_on_top)};
  }

 private:
  __m256 low_, high_;
#else
  explicit FloatTable16(const float* table) { std::copy(table, table + 16, table_); }
  Floats operator[](Words index) const {
    const hn::RebindToSigned<D> d;
    return hn::GatherIndex(D(), table_, hn::And(hn::BitCast(d, index), hn::Set(d, 15)));
  }

 private:
  alignas(64) float table_[16];
#endif
};

}  // namespace shimmer::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
