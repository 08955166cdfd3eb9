// Weighted sums of rows of samples: what a mean over frames is made of.
#pragma once

#include <cstdint>

namespace shimmer::restore {

// sum[i] += weight * samples[i]. Sample: uint8_t, uint16_t or float.
template <class Sample>
void AddSamples(const Sample* samples, float weight, int count, float* sum) {
  for (int i = 0; i < count; ++i) sum[i] += weight * static_cast<float>(samples[i]);
}

// The same for two rows, in one pass over the sums.
template <class Sample>
void AddSamples(const Sample* a, const Sample* b, float weight_a, float weight_b, int count, float* sum) {
  for (int i = 0; i < count; ++i)
    sum[i] = sum[i] + weight_a * static_cast<float>(a[i]) + weight_b * static_cast<float>(b[i]);
}

// For px of so many channels with a weight each: sum += weight * px_weight / 255 * sample, and weights +=
// weight * px_weight / 255.
template <class Sample>
void AddWeighed(const Sample* samples, const uint8_t* px_weight, float weight, int px, int channels,
                float* sum, float* weights) {
  for (int x = 0; x < px; ++x) {
    const float own = weight * (static_cast<float>(px_weight[x]) / 255);
    weights[x] += own;
    for (int c = 0; c < channels; ++c)
      sum[x * channels + c] += own * static_cast<float>(samples[x * channels + c]);
  }
}

}  // namespace shimmer::restore
