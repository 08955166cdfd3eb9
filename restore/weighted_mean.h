// Weighted sums of rows of samples: what a mean over frames is made of.
#pragma once

#include <array>
#include <cstdint>

namespace shimmer::restore {

// sum[i] += weight * samples[i]. Sample: uint8_t, uint16_t or float.
template <class Sample>
void AddSamples(const Sample* samples, float weight, int count, float* sum) {
  for (int i = 0; i < count; ++i) sum[i] += weight * static_cast<float>(samples[i]);
}

// The same for four rows, in one pass over the sums.
template <class Sample>
void AddSamples(const std::array<const Sample*, 4>& rows, const std::array<float, 4>& weights, int count,
                float* sum) {
  const Sample *a = rows[0], *b = rows[1], *c = rows[2], *d = rows[3];
  const float of_a = weights[0], of_b = weights[1], of_c = weights[2], of_d = weights[3];
  for (int i = 0; i < count; ++i)
    sum[i] = sum[i] + of_a * static_cast<float>(a[i]) + of_b * static_cast<float>(b[i]) +
             of_c * static_cast<float>(c[i]) + of_d * static_cast<float>(d[i]);
}

// For px with a weight each: sum += weight * px_weight / 255 * sample, and weights += weight * px_weight /
// 255.
template <int kChannels, class Sample>
void AddWeighed(const Sample* samples, const uint8_t* px_weight, float weight, int px, float* sum,
                float* weights) {
  const float unit = weight / 255;
  for (int x = 0; x < px; ++x) {
    const float own = unit * static_cast<float>(px_weight[x]);
    weights[x] += own;
    for (int c = 0; c < kChannels; ++c)
      sum[x * kChannels + c] += own * static_cast<float>(samples[x * kChannels + c]);
  }
}

}  // namespace shimmer::restore
