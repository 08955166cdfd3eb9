#include "sim/stack_blur.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/gaussian.h"
#include "sim/parallel.h"

namespace shimmer::sim {
namespace {

// out[i] = w[0] in(0)[i] + sum_k w[k] (in(-k)[i] + in(k)[i]), in(k) the row or the pixels k steps away.
template <class Neighbour>
void Convolve(const std::vector<double>& weights, const Neighbour& in, int count, float* out,
              std::vector<double>& sum) {
  sum.resize(static_cast<size_t>(count));
  const float* centre = in(0);
  for (int i = 0; i < count; ++i) sum[i] = weights[0] * centre[i];
  for (int k = 1; k < static_cast<int>(weights.size()); ++k) {
    const float *before = in(-k), *after = in(k);
    for (int i = 0; i < count; ++i) sum[i] += weights[k] * (double{before[i]} + after[i]);
  }
  std::copy(sum.begin(), sum.end(), out);
}

}  // namespace

cv::Mat GaussianBlur(const cv::Mat& frame, double sigma_px, int border_px) {
  std::vector<double> weights;
  GaussianWeights(sigma_px, weights);
  const int radius = static_cast<int>(weights.size()) - 1;
  const int width = frame.cols - 2 * border_px, height = frame.rows - 2 * border_px,
            channels = frame.channels();

  cv::Mat rows_done(height + 2 * radius, width, frame.type()), blurred(height, width, frame.type());
  ParallelFor(0, rows_done.rows, [&](int y) {
    std::vector<double> sum;
    const float* row = frame.ptr<float>(y + border_px - radius) + border_px * channels;
    Convolve(
        weights, [&](int k) { return row + k * channels; }, width * channels, rows_done.ptr<float>(y), sum);
  });
  ParallelFor(0, height, [&](int y) {
    std::vector<double> sum;
    Convolve(
        weights, [&](int k) { return rows_done.ptr<float>(y + radius + k); }, width * channels,
        blurred.ptr<float>(y), sum);
  });
  return blurred;
}

BlurStack::BlurStack(const cv::Mat& frame, double min_sigma_px, double max_sigma_px)
    : min_sigma_px_(min_sigma_px),
      max_sigma_px_(max_sigma_px),
      step_px_((max_sigma_px - min_sigma_px) / (kStackLevels - 1)) {
  const int border_px = GaussianRadius(max_sigma_px);
  for (int level = 0; level < kStackLevels; ++level)
    levels_.push_back(GaussianBlur(frame, sigma_px(level), border_px));
}

// Rounding must not carry the last level beyond the maximum, for which the border is made.
double BlurStack::sigma_px(int level) const {
  return std::min(min_sigma_px_ + step_px_ * level, max_sigma_px_);
}

void BlurStack::Row(cv::Point first, std::span<const float> sigma_px, LevelChoice choice, float* out) const {
  const int channels = levels_[0].channels();
  for (size_t i = 0; i < sigma_px.size(); ++i, out += channels) {
    const double place =
        step_px_ > 0 ? std::clamp((sigma_px[i] - min_sigma_px_) / step_px_, 0.0, kStackLevels - 1.0) : 0;
    const int below = std::min(static_cast<int>(place), kStackLevels - 2);
    double share = place - below;  // of the level above
    if (choice == LevelChoice::kNearest) share = std::floor(share + 0.5);
    const int offset = (first.x + static_cast<int>(i)) * channels;
    const float *low = levels_[below].ptr<float>(first.y) + offset,
                *high = levels_[below + 1].ptr<float>(first.y) + offset;
    for (int c = 0; c < channels; ++c) out[c] = static_cast<float>((1 - share) * low[c] + share * high[c]);
  }
}

}  // namespace shimmer::sim
