#include "sim/colour.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/colour.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "noise/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using noise::HWY_NAMESPACE::ForEachVector;

// Polynomials of least largest relative error by Remez exchange, constant first.
// (1 + t)^2.4 and (1 + t)^(1 / 2.4), t in [sqrt(1/2) - 1, sqrt(2) - 1]: error 9e-8 and 4e-8
constexpr float kPower12Fifths[] = {1.0f,          2.40000033f,  1.68000162f,    0.223972663f,
                                    -0.033654038f, 0.011217289f, -0.00437908107f};
constexpr float kPower5Twelfths[] = {1.0f,           0.416667104f, -0.121531308f,  0.0641032234f,
                                     -0.0412555039f, 0.030389329f, -0.0255038161f, 0.0153240487f};
// 2^a, a in [-1/2, 1/2]: error 2e-8
constexpr float kPowerOfTwo[] = {1.0f,           0.693147182f,   0.240226462f,   0.0555032864f,
                                 0.00961848907f, 0.00133999309f, 0.000153458124f};

template <class D, size_t n, class V = hn::Vec<D>>
HWY_INLINE V Polynomial(D d, const float (&coefficients)[n], V t) {
  V sum = hn::Set(d, coefficients[n - 1]);
  for (size_t i = n - 1; i-- > 0;) sum = hn::Add(hn::Mul(sum, t), hn::Set(d, coefficients[i]));
  return sum;
}

// x^(over / under), x > 0 and normal; infinite above the largest float. x = 2^e (1 + t): of_mantissa gives
// the power of 1 + t, and 2^(e over / under) = 2^whole 2^(rest / under) with whole and rest exact.
template <int kOver, int kUnder, class D, size_t n, class V = hn::Vec<D>>
HWY_INLINE V Power(D d, V x, const float (&of_mantissa)[n]) {
  const hn::RebindToSigned<D> di;
  constexpr int kHalfRoot = 0x3f3504f3;  // sqrt(1/2) as a float
  const auto bits = hn::BitCast(di, x);
  const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, kHalfRoot)));
  const V mantissa = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
  const V scaled = hn::Mul(hn::ConvertTo(d, exponent), hn::Set(d, float{kOver}));
  const V whole = hn::Round(hn::Mul(scaled, hn::Set(d, 1.0f / kUnder)));
  const V rest = hn::Sub(scaled, hn::Mul(whole, hn::Set(d, float{kUnder})));
  const auto biased = hn::Min(hn::Add(hn::ConvertTo(di, whole), hn::Set(di, 127)), hn::Set(di, 255));
  const V fraction = Polynomial(d, kPowerOfTwo, hn::Mul(rest, hn::Set(d, 1.0f / kUnder)));
  const V root = Polynomial(d, of_mantissa, hn::Sub(mantissa, hn::Set(d, 1.0f)));
  return hn::Mul(hn::Mul(root, fraction), hn::BitCast(d, hn::ShiftLeft<23>(biased)));
}

// Every sample v becomes f(tag, v).
template <class F>
HWY_INLINE void Map(std::span<float> samples, const F& f) {
  ForEachVector(samples.size(), [&](auto d, size_t i) HWY_ATTR {
    float* at = samples.data() + i;
    hn::StoreU(f(d, hn::LoadU(d, at)), d, at);
  });
}

void DecodeSrgbRow(std::span<float> samples) {
  Map(samples, [](auto d, auto v) HWY_ATTR {
    const auto base = hn::Mul(hn::Add(v, hn::Set(d, 0.055f)), hn::Set(d, 1 / 1.055f));
    return hn::IfThenElse(hn::Le(v, hn::Set(d, 0.04045f)), hn::Mul(v, hn::Set(d, 1 / 12.92f)),
                          Power<12, 5>(d, base, kPower12Fifths));
  });
}

void EncodeSrgbRow(std::span<float> samples) {
  Map(samples, [](auto d, auto v) HWY_ATTR {
    const auto light = hn::Max(v, hn::Zero(d));
    const auto power = Power<5, 12>(d, light, kPower5Twelfths);
    return hn::IfThenElse(hn::Le(v, hn::Set(d, 0.0031308f)), hn::Mul(light, hn::Set(d, 12.92f)),
                          hn::Sub(hn::Mul(power, hn::Set(d, 1.055f)), hn::Set(d, 0.055f)));
  });
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::sim {
namespace {

template <class F>
cv::Mat Map(const cv::Mat& image, const F& f) {
  cv::Mat mapped = image.clone();
  for (int y = 0; y < mapped.rows; ++y)
    f({mapped.ptr<float>(y), static_cast<size_t>(mapped.cols) * mapped.channels()});
  return mapped;
}

}  // namespace

HWY_EXPORT(DecodeSrgbRow);
HWY_EXPORT(EncodeSrgbRow);

void DecodeSrgbRow(std::span<float> samples) { HWY_DYNAMIC_DISPATCH(DecodeSrgbRow)(samples); }
void EncodeSrgbRow(std::span<float> samples) { HWY_DYNAMIC_DISPATCH(EncodeSrgbRow)(samples); }

cv::Mat DecodeSrgb(const cv::Mat& stored) {
  return Map(stored, [](std::span<float> row) { DecodeSrgbRow(row); });
}
cv::Mat EncodeSrgb(const cv::Mat& linear) {
  return Map(linear, [](std::span<float> row) { EncodeSrgbRow(row); });
}

}  // namespace shimmer::sim
#endif
