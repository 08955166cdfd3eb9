#include "tests/bench/scalar_noise.h"

#include <cmath>

#include "noise/lattice.h"

namespace shimmer::bench {
namespace {

const noise::Permutation& table = noise::ClassicPermutation();

int Hash(int index) { return table[static_cast<size_t>(index & 255)]; }

float Along(const float (&gradient)[3], float x, float y, float z) {
  return gradient[0] * x + gradient[1] * y + gradient[2] * z;
}

float Lerp(float t, float a, float b) { return a + t * (b - a); }
float Fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

}  // namespace

float ScalarSimplex(float x, float y, float z) {
  const float skew = (x + y + z) * (1.0f / 3);
  const float cell_x = std::floor(x + skew), cell_y = std::floor(y + skew), cell_z = std::floor(z + skew);
  const float unskew = (cell_x + cell_y + cell_z) * (1.0f / 6);
  const float x0 = x - (cell_x - unskew), y0 = y - (cell_y - unskew), z0 = z - (cell_z - unskew);
  const int i = static_cast<int>(cell_x), j = static_cast<int>(cell_y), k = static_cast<int>(cell_z);

  // The axis of the largest offset is stepped along first, that of the smallest last.
  const bool xy = x0 >= y0, yz = y0 >= z0, xz = x0 >= z0;
  const bool x_first = xy && xz, y_first = !xy && yz, z_first = !x_first && !y_first;
  const int steps[4][3] = {
      {0, 0, 0}, {x_first, y_first, z_first}, {xy || xz, !xy || yz, !(xz && yz)}, {1, 1, 1}};
  float sum = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const auto& [a, b, c] = steps[corner];
    const float back = static_cast<float>(corner) * (1.0f / 6);
    const float px = x0 - static_cast<float>(a) + back, py = y0 - static_cast<float>(b) + back,
                pz = z0 - static_cast<float>(c) + back;
    const float reach = 0.6f - px * px - py * py - pz * pz;
    if (reach <= 0) continue;
    const int hash = Hash(i + a + Hash(j + b + Hash(k + c)));
    sum += reach * reach * reach * reach * Along(noise::kGradients[hash % 12], px, py, pz);
  }
  return 32 * sum;
}

float ScalarPerlin(float x, float y, float z) {
  const float cell_x = std::floor(x), cell_y = std::floor(y), cell_z = std::floor(z);
  const int i = static_cast<int>(cell_x), j = static_cast<int>(cell_y), k = static_cast<int>(cell_z);
  x -= cell_x, y -= cell_y, z -= cell_z;
  const float fade_x = Fade(x), fade_y = Fade(y), fade_z = Fade(z);

  float layers[2];
  for (int c = 0; c < 2; ++c) {
    float rows[2];
    for (int b = 0; b < 2; ++b) {
      const auto corner = [&](int a) {
        const int hash = Hash(Hash(Hash(i + a) + j + b) + k + c);
        return Along(noise::kGradients[hash & 15], x - static_cast<float>(a), y - static_cast<float>(b),
                     z - static_cast<float>(c));
      };
      rows[b] = Lerp(fade_x, corner(0), corner(1));
    }
    layers[c] = Lerp(fade_y, rows[0], rows[1]);
  }
  return Lerp(fade_z, layers[0], layers[1]);
}

}  // namespace shimmer::bench
