// The normal distribution function in vectors, of which GELU is made: gelu(x) = x Phi(x).
#if defined(SHIMMER_RESTORE_NORMAL_SHARE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHIMMER_RESTORE_NORMAL_SHARE_INL_H_
#undef SHIMMER_RESTORE_NORMAL_SHARE_INL_H_
#else
#define SHIMMER_RESTORE_NORMAL_SHARE_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace shimmer::restore::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Phi(x) = (1 + erf(x / sqrt(2))) / 2, off by 1e-7 at most.
//
// With a = |x|: Phi(-a) = 2^(a s(a) - 1), s a polynomial fitted to log2(2 Phi(-a)) / a on [0, 5.6] so that
// the largest error of Phi(-a) is the least (8e-9); 2^f by a polynomial on [-1/2, 1/2], off by 2e-9 of it,
// both by iterated weighted least squares. Beyond 5.6, where Phi(-a) < 1.1e-8, it is 0, so that x Phi(x)
// vanishes.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V NormalShare(D d, V x) {
  const hn::RebindToSigned<D> di;
  const auto c = [&](float v) HWY_ATTR { return hn::Set(d, v); };
  const V a = hn::Min(hn::Abs(x), c(5.6f));
  V s = hn::MulAdd(c(-2.834912681e-06f), a, c(3.937769002e-05f));
  s = hn::MulAdd(s, a, c(-0.0001861802368f));
  s = hn::MulAdd(s, a, c(-0.0001369363764f));
  s = hn::MulAdd(s, a, c(0.007063420131f));
  s = hn::MulAdd(s, a, c(-0.05249617835f));
  s = hn::MulAdd(s, a, c(-0.4592081967f));
  s = hn::MulAdd(s, a, c(-1.151105205f));
  const V exponent = hn::MulAdd(s, a, c(-1)), whole = hn::Round(exponent), f = hn::Sub(exponent, whole);
  V power = hn::MulAdd(c(0.0001535336183f), f, c(0.001339887444f));
  power = hn::MulAdd(power, f, c(0.009618437358f));
  power = hn::MulAdd(power, f, c(0.05550332471f));
  power = hn::MulAdd(power, f, c(0.2402264791f));
  power = hn::MulAdd(power, f, c(0.6931472029f));
  power = hn::MulAdd(power, f, c(1));
  const auto scale = hn::ShiftLeft<23>(hn::ConvertTo(di, whole));  // whole in [-27, 0]: no denormals
  const V lower = hn::BitCast(d, hn::Add(hn::BitCast(di, power), scale));
  const V tail = hn::IfThenElseZero(hn::Lt(hn::Abs(x), c(5.6f)), lower);
  return hn::IfThenElse(hn::Lt(x, hn::Zero(d)), tail, hn::Sub(c(1), tail));
}

}  // namespace shimmer::restore::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
