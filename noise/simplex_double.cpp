#include "noise/simplex_double.h"

#include <algorithm>
#include <cmath>

namespace shimmer::noise {
namespace {

struct Corner {
  int i, j, k;  // in the cell, 0 or 1
};

// The two corners between (0, 0, 0) and (1, 1, 1): first the axis of the largest offset, then the two larger
// ones.
void MiddleCorners(double x, double y, double z, Corner& first, Corner& second) {
  if (x >= y) {
    if (y >= z)
      first = {1, 0, 0}, second = {1, 1, 0};
    else if (x >= z)
      first = {1, 0, 0}, second = {1, 0, 1};
    else
      first = {0, 0, 1}, second = {1, 0, 1};
  } else {
    if (y < z)
      first = {0, 0, 1}, second = {0, 1, 1};
    else if (x < z)
      first = {0, 1, 0}, second = {0, 1, 1};
    else
      first = {0, 1, 0}, second = {1, 1, 0};
  }
}

size_t Byte(double cell) { return static_cast<size_t>(static_cast<int64_t>(cell) & 255); }

}  // namespace

double SimplexDouble(const Permutation& permutation, const SimplexKernel& kernel, double x, double y,
                     double z) {
  const double skew = (x + y + z) / 3;
  const double i = std::floor(x + skew), j = std::floor(y + skew), k = std::floor(z + skew);
  const double unskew = (i + j + k) / 6;
  const double x0 = x - (i - unskew), y0 = y - (j - unskew), z0 = z - (k - unskew);

  Corner corners[4] = {{0, 0, 0}, {}, {}, {1, 1, 1}};
  MiddleCorners(x0, y0, z0, corners[1], corners[2]);

  double sum = 0;
  for (const Corner& c : corners) {
    const double back = (c.i + c.j + c.k) / 6.0;
    const double px = x0 - c.i + back, py = y0 - c.j + back, pz = z0 - c.k + back;
    const double reach = std::max(0.0, kernel.radius2 - px * px - py * py - pz * pz);
    const uint8_t hash_z = permutation[Byte(k + c.k)];
    const uint8_t hash_yz = permutation[(Byte(j + c.j) + hash_z) & 255];
    const uint8_t hash = permutation[(Byte(i + c.i) + hash_yz) & 255];
    const float* gradient = kGradients[hash % 12];
    sum += reach * reach * reach * reach * (gradient[0] * px + gradient[1] * py + gradient[2] * pz);
  }
  return kernel.scale * sum;
}

double SimplexFaceDistance(double x, double y, double z) {
  const double skew = (x + y + z) / 3;
  double u = x + skew, v = y + skew, w = z + skew;
  u -= std::floor(u), v -= std::floor(v), w -= std::floor(w);
  const double between_simplices = std::min({std::abs(u - v), std::abs(v - w), std::abs(u - w)});
  const double between_cells = std::min({u, v, w, 1 - u, 1 - v, 1 - w});
  return std::min(between_simplices, between_cells);
}

}  // namespace shimmer::noise
