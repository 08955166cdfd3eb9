// Simplex and Perlin noise one point at a time in float32, as the noise library that the paper names computes
// them (the definitions are those of noise/simplex_double.h and noise/perlin_double.h, with Perlin's table):
// what peers of this project pay for noise. Only for benchmarks.
#pragma once

namespace shimmer::bench {

float ScalarSimplex(float x, float y, float z);
float ScalarPerlin(float x, float y, float z);

// sum_i 2^-i n(2^i (x, y, z)) / sum_i 2^-i, in float32 throughout.
template <class Noise>
float ScalarOctaves(const Noise& noise, int octaves, float x, float y, float z) {
  float sum = 0, amplitudes = 0, frequency = 1, amplitude = 1;
  for (int i = 0; i < octaves; ++i, frequency *= 2, amplitude *= 0.5f) {
    sum += amplitude * noise(x * frequency, y * frequency, z * frequency);
    amplitudes += amplitude;
  }
  return sum / amplitudes;
}

}  // namespace shimmer::bench
