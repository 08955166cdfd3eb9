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

// Phi(x) = (1 + erf(x / sqrt(2))) / 2, off by 1.1e-7 at most.
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
  // Polynomials by halves, whose steps do not all wait for each other.
  const V a2 = hn::Mul(a, a), a4 = hn::Mul(a2, a2);
  const V s01 = hn::MulAdd(a, c(-0.4592081967f), c(-1.151105205f));
  const V s23 = hn::MulAdd(a, c(0.007063420131f), c(-0.05249617835f));
  const V s45 = hn::MulAdd(a, c(-0.0001861802368f), c(-0.0001369363764f));
  const V s67 = hn::MulAdd(a, c(-2.834912681e-06f), c(3.937769002e-05f));
  const V s = hn::MulAdd(a4, hn::MulAdd(a2, s67, s45), hn::MulAdd(a2, s23, s01));
  const V exponent = hn::MulAdd(s, a, c(-1)), whole = hn::Round(exponent), f = hn::Sub(exponent, whole);
  const V f2 = hn::Mul(f, f), f4 = hn::Mul(f2, f2);
  const V p01 = hn::MulAdd(f, c(0.6931472029f), c(1));
  const V p23 = hn::MulAdd(f, c(0.05550332471f), c(0.2402264791f));
  const V p45 = hn::MulAdd(f, c(0.001339887444f), c(0.009618437358f));
  const V power = hn::MulAdd(f4, hn::MulAdd(f2, c(0.0001535336183f), p45), hn::MulAdd(f2, p23, p01));
  const auto scale = hn::ShiftLeft<23>(hn::ConvertTo(di, whole));  // whole in [-27, 0]: no denormals
  const V lower = hn::BitCast(d, hn::Add(hn::BitCast(di, power), scale));
  const V tail = hn::IfThenElseZero(hn::Lt(hn::Abs(x), c(5.6f)), lower);
  return hn::IfThenElse(hn::Lt(x, hn::Zero(d)), tail, hn::Sub(c(1), tail));
}

}  // namespace shimmer::restore::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
