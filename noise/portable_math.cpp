#include "noise/portable_math.h"

#include <cmath>
#include <limits>

namespace shimmer::noise {

double Exp(double x) {
  if (x < -745.2) return 0;
  if (x > 709.78) return std::numeric_limits<double>::infinity();
  // x = n log 2 + r, |r| <= 0.35. log 2 in two parts: the first has 32 bits, so that n times it is exact.
  constexpr double kLog2High = 0x1.62e42fefp-1, kLog2Low = 0x1.473de6af278edp-34;
  const double n = std::floor(x * 1.4426950408889634 + 0.5);
  const double r = (x - n * kLog2High) - n * kLog2Low;
  double sum = 1;  // Taylor by Horner: r^15 / 15! < 2e-19
  for (int k = 14; k >= 1; --k) sum = 1 + sum * r / k;
  return std::ldexp(sum, static_cast<int>(n));
}

double Log(double x) {
  int exponent;
  double m = std::frexp(x, &exponent);  // [0.5, 1)
  if (m < 0.70710678118654752) m *= 2, --exponent;
  // log m = 2 atanh s, s = (m - 1) / (m + 1), |s| < 0.172: s^25 / 25 < 3e-21
  const double s = (m - 1) / (m + 1), s2 = s * s;
  double sum = 0;
  for (int k = 23; k >= 1; k -= 2) sum = sum * s2 + 1.0 / k;
  return exponent * 0.6931471805599453 + 2 * s * sum;
}

double Cos(double x) {
  // To [-pi, pi], then cos x = 1 - 2 sin^2(x / 2) with the sine's Taylor series: r^23 / 23! < 2e-18 for r <=
  // pi / 2
  constexpr double kTurnHigh = 0x1.921fb544p2, kTurnLow = 0x1.0b4611a626331p-32;  // 2 pi in two parts
  const double turns = std::floor(x / (kTurnHigh + kTurnLow) + 0.5);
  const double r = 0.5 * ((x - turns * kTurnHigh) - turns * kTurnLow), r2 = r * r;
  double sum = 1;
  for (int k = 22; k >= 2; k -= 2) sum = 1 - sum * r2 / (k * (k + 1));
  const double sine = r * sum;
  return 1 - 2 * sine * sine;
}

double NormalCdf(double x) {
  if (!(std::abs(x) < 8.3)) return x < 0 ? 0 : 1;
  // Phi = 1/2 + phi(x) (x + x^3 / 3 + x^5 / (3 5) + ...): terms of one sign, nothing cancels.
  double term = x, sum = x;
  for (int k = 3; std::abs(term) > 1e-18 * std::abs(sum); k += 2) sum += term *= x * x / k;
  return 0.5 + 0.3989422804014327 * Exp(-0.5 * x * x) * sum;
}

double NormalQuantile(double p) {
  double low = -8.3, high = 8.3;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (NormalCdf(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace shimmer::noise
