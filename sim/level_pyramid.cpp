#include "sim/level_pyramid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "sim/row_kernels.h"

namespace shimmer::sim {
namespace {

// A plane convolved with a symmetric kernel, of which every step-th row and column is kept. Edge pixels go on
// beyond it.
cv::Mat SmoothAndThin(const cv::Mat& plane, const std::vector<double>& kernel, int step) {
  const std::vector<float> weights(kernel.begin(), kernel.end());
  const int radius = static_cast<int>(weights.size()) - 1;
  cv::Mat thin((plane.rows + step - 1) / step, (plane.cols + step - 1) / step, CV_32F);
  tbb::parallel_for(0, thin.rows, [&](int row) {
    std::vector<const float*> before(weights.size()), after(weights.size());
    const int y = row * step;
    for (int k = 1; k <= radius; ++k) {
      before[k] = plane.ptr<float>(std::max(y - k, 0));
      after[k] = plane.ptr<float>(std::min(y + k, plane.rows - 1));
    }
    std::vector<float> down(static_cast<size_t>(plane.cols + 2 * radius)),
        along(static_cast<size_t>(plane.cols));
    const std::span<float> inside(down.data() + radius, along.size());
    ConvolveRow(weights, plane.ptr<float>(y), before.data(), after.data(), inside);
    std::fill_n(down.begin(), radius, inside.front());
    std::fill_n(down.end() - radius, radius, inside.back());
    for (int k = 1; k <= radius; ++k) before[k] = inside.data() - k, after[k] = inside.data() + k;
    ConvolveRow(weights, inside.data(), before.data(), after.data(), along);
    float* out = thin.ptr<float>(row);
    for (int x = 0; x < thin.cols; ++x) out[x] = along[static_cast<size_t>(x) * step];
  });
  return thin;
}

}  // namespace

std::vector<CoarsePlane> CoarseLevels(const cv::Mat& plane, const LevelLadder& ladder) {
  std::vector<CoarsePlane> coarse;
  for (const BlurLevel& level : ladder.levels()) {
    if (level.spacing_px == 1) {
      coarse.push_back({1, {}});
    } else {
      const CoarsePlane& from = coarse.back();
      const cv::Mat& smooth = from.spacing_px == 1 ? plane : from.coefficients;
      coarse.push_back(
          {level.spacing_px, SmoothAndThin(smooth, level.kernel, level.spacing_px / from.spacing_px)});
    }
  }
  return coarse;
}

void CoarseRow(const CoarsePlane& plane, int y, int x0, std::span<float> out, std::vector<float>& scratch) {
  const int spacing = plane.spacing_px, row = y / spacing;
  const float t = static_cast<float>(y % spacing) / static_cast<float>(spacing), s = 1 - t;
  const std::array<float, 4> weights = {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                                        (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};

  // Down the columns at the grid's own width, then finer and finer along the row; two buffers take turns.
  // Each holds coefficients from point -2 to point n + 3, n the points in out, which is just what the next
  // finer grid's take.
  constexpr size_t kBefore = 2, kAround = 6;
  scratch.resize(out.size() + 2 * kAround);
  float *now = scratch.data(), *finer = now + scratch.size() / 2;
  std::array<const float*, 4> rows;
  for (int k = 0; k < 4; ++k)
    rows[k] = plane.coefficients.ptr<float>(row + k - 1) + x0 / spacing - static_cast<int>(kBefore);
  MixFourRows(weights, rows.data(), {now, out.size() / static_cast<size_t>(spacing) + kAround});
  for (int at = spacing / 2; at > 1; at /= 2) {
    RefineSpline(now, {finer, out.size() / static_cast<size_t>(at) + kAround});
    std::swap(now, finer);
  }
  EvaluateSpline(now + kBefore - 1, out);
}

}  // namespace shimmer::sim
