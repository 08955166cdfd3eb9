#include "noise/perlin_double.h"

#include <cmath>

namespace shimmer::noise {
namespace {

double Fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

double Lerp(double t, double a, double b) { return a + t * (b - a); }

}  // namespace

double PerlinDouble(const Permutation& permutation, double x, double y, double z) {
  const double floor_x = std::floor(x), floor_y = std::floor(y), floor_z = std::floor(z);
  const auto i = static_cast<int64_t>(floor_x), j = static_cast<int64_t>(floor_y),
             k = static_cast<int64_t>(floor_z);
  x -= floor_x, y -= floor_y, z -= floor_z;

  const auto hash = [&](int64_t index) { return int64_t{permutation[static_cast<size_t>(index & 255)]}; };
  const auto corner = [&](int a, int b, int c) {
    const float* gradient = kGradients[hash(hash(hash(i + a) + j + b) + k + c) & 15];
    return gradient[0] * (x - a) + gradient[1] * (y - b) + gradient[2] * (z - c);
  };
  const auto along_x = [&](int b, int c) { return Lerp(Fade(x), corner(0, b, c), corner(1, b, c)); };
  const auto along_y = [&](int c) { return Lerp(Fade(y), along_x(0, c), along_x(1, c)); };
  return Lerp(Fade(z), along_y(0), along_y(1));
}

}  // namespace shimmer::noise
