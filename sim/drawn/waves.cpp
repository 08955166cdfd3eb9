#include "sim/drawn/waves.h"

#include <numbers>

namespace shimmer::sim {

double CosTurns(double turns) {
  // cos(2 pi v) = -sin(2 pi (v - 1/4)) with v in [0, 1/2], so the sine's argument stays within a quarter
  // turn.
  const double v = std::abs(turns - std::floor(turns + 0.5));
  const double x = 2 * std::numbers::pi * (v - 0.25), x2 = x * x;
  double sum = 0;
  for (int n = 17; n > 1; n -= 2) sum = (1 + sum) * -x2 / (n * (n - 1));  // Taylor's series by Horner's rule
  return -x * (1 + sum);
}

double AngleTurns(double x, double y) {
  const double ax = std::abs(x), ay = std::abs(y);
  if (ax == 0 && ay == 0) return 0;
  const double ratio = std::min(ax, ay) / std::max(ax, ay);  // tangent of an angle in [0, 1/8] turn
  // Beyond 1/16 turn, go by the angle from 1/8 turn: |t| <= tan(1/16 turn), where the series is short.
  const bool far = ratio > std::numbers::sqrt2 - 1;
  const double t = far ? (ratio - 1) / (ratio + 1) : ratio, t2 = t * t;
  double sum = 0;
  for (int n = 25; n > 1; n -= 2) sum = (1.0 / n + sum) * -t2;
  double angle = t * (1 + sum) / (2 * std::numbers::pi) + (far ? 0.125 : 0);
  if (ay > ax) angle = 0.25 - angle;
  if (x < 0) angle = 0.5 - angle;
  return y < 0 ? -angle : angle;
}

double SquareCoverage(double turns, double width) {
  const auto integral = [](double u) {  // of the wave from 0 to u
    const double whole = std::floor(u);
    return 0.5 * whole + std::min(u - whole, 0.5);
  };
  return std::clamp((integral(turns + width / 2) - integral(turns - width / 2)) / width, 0.0, 1.0);
}

}  // namespace shimmer::sim
