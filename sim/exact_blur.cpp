#include "sim/exact_blur.h"

#include <vector>

#include "sim/gaussian.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/exact_blur.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// sum[i] += weight (a[i] + b[i]) for whole vectors from i on; returns the first i that is left.
// Each element on its own: no order of summation that could depend on the vector's length.
template <class Tag>
size_t AddRows(Tag d, const float* a, const float* b, double weight, double* sum, size_t i, size_t count) {
  const hn::Rebind<float, Tag> df;
  const auto w = hn::Set(d, weight);
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
    const auto both = hn::Add(hn::PromoteTo(d, hn::LoadU(df, a + i)), hn::PromoteTo(d, hn::LoadU(df, b + i)));
    hn::StoreU(hn::Add(hn::LoadU(d, sum + i), hn::Mul(w, both)), d, sum + i);
  }
  return i;
}

void ExactBlurRow(const cv::Mat& frame, cv::Point first, std::span<const float> sigma_px, float* out) {
  const hn::ScalableTag<double> vectors;
  const hn::CappedTag<double, 1> rest;
  const int channels = frame.channels();
  std::vector<double> weights, columns;

  for (size_t i = 0; i < sigma_px.size(); ++i, out += channels) {
    GaussianWeights(sigma_px[i], weights);
    const int radius = static_cast<int>(weights.size()) - 1;
    const size_t count = static_cast<size_t>(2 * radius + 1) * channels;
    const int left = (first.x + static_cast<int>(i) - radius) * channels;

    // Down the columns first, the two rows at equal distance together; then along the row of sums.
    columns.resize(count);
    const float* centre = frame.ptr<float>(first.y) + left;
    for (size_t k = 0; k < count; ++k) columns[k] = weights[0] * centre[k];
    for (int j = 1; j <= radius; ++j) {
      const float *above = frame.ptr<float>(first.y - j) + left,
                  *below = frame.ptr<float>(first.y + j) + left;
      const size_t done = AddRows(vectors, above, below, weights[j], columns.data(), 0, count);
      AddRows(rest, above, below, weights[j], columns.data(), done, count);
    }
    for (int c = 0; c < channels; ++c) {
      double sum = weights[0] * columns[radius * channels + c];
      for (int k = 1; k <= radius; ++k)
        sum += weights[k] * (columns[(radius - k) * channels + c] + columns[(radius + k) * channels + c]);
      out[c] = static_cast<float>(sum);
    }
  }
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::sim {

HWY_EXPORT(ExactBlurRow);

void ExactBlurRow(const cv::Mat& frame, cv::Point first, std::span<const float> sigma_px, float* out) {
  HWY_DYNAMIC_DISPATCH(ExactBlurRow)(frame, first, sigma_px, out);
}

}  // namespace shimmer::sim
#endif
