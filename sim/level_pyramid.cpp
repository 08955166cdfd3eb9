#include "sim/level_pyramid.h"

#include <algorithm>

#include "sim/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/level_pyramid.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/row_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace shimmer::sim::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Room around a row for a kernel's radius and a vector.
constexpr size_t kRoom = 2 * 16;

// A symmetric kernel along a row of which every step-th element is kept, step 1 or 2. Reads
// in[-radius .. step (count - 1) + radius], and up to two vectors on from the last one kept.
template <int radius, int step>
HWY_INLINE void ConvolveAlong(const HalfKernel<radius>& kernel, const float* in, std::span<float> out) {
  CoverWithVectors(out.size(), [&](auto d, size_t i) HWY_ATTR {
    const float* from = in + step * i;
    const auto at = [&](int k) HWY_ATTR {
      if constexpr (step == 1) return hn::LoadU(d, from + k);
      return LoadEven(d, from + k);
    };
    hn::StoreU(SymmetricSum<radius>(d, kernel, at), d, out.data() + i);
  });
}

// Rows [first_row, last_row) of a plane convolved with a symmetric kernel, of which every step-th row and
// column is kept.
void SmoothAndThin(const cv::Mat& plane, std::span<const float> weights, int step, int first_row,
                   int last_row, cv::Mat& thin) {
  const int radius = static_cast<int>(weights.size()) - 1;
  const auto width = static_cast<size_t>(plane.cols);
  std::vector<float> down(width + 2 * kRoom);
  const std::span<float> inside(down.data() + kRoom, width);
  std::array<const float*, 2 * kMostKernelRadius + 1> rows;
  WithRadius(radius, [&](auto constant) HWY_ATTR {
    constexpr int kRadius = constant;
    const HalfKernel<kRadius> kernel(weights.data());
    for (int row = first_row; row < last_row; ++row) {
      for (int k = -kRadius; k <= kRadius; ++k)
        rows[kRadius + k] = plane.ptr<float>(std::clamp(row * step + k, 0, plane.rows - 1));
      ConvolveDown<kRadius>(kernel, rows.data(), inside);
      std::fill(down.begin(), down.begin() + kRoom, inside.front());
      std::fill(down.end() - kRoom, down.end(), inside.back());
      const std::span<float> out(thin.ptr<float>(row), static_cast<size_t>(thin.cols));
      if (step == 1)
        ConvolveAlong<kRadius, 1>(kernel, inside.data(), out);
      else
        ConvolveAlong<kRadius, 2>(kernel, inside.data(), out);
    }
  });
}

}  // namespace shimmer::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace shimmer::sim {

HWY_EXPORT(SmoothAndThin);

std::vector<CoarseLevel> CoarseLevels(const Planes& frame, const LevelLadder& ladder) {
  constexpr int kRowsAtATime = 32;
  std::vector<CoarseLevel> coarse;
  for (const BlurLevel& level : ladder.levels()) {
    coarse.push_back({level.spacing_px, {}});
    if (level.spacing_px == 1) continue;
    const CoarseLevel& before = coarse[coarse.size() - 2];
    const Planes& from = before.spacing_px == 1 ? frame : before.coefficients;
    const int step = level.spacing_px / before.spacing_px;
    const cv::Size size((from[0].cols + step - 1) / step, (from[0].rows + step - 1) / step);
    Planes& to = coarse.back().coefficients;
    for (size_t c = 0; c < frame.size(); ++c) to.emplace_back(size, CV_32F);
    const std::vector<float> weights(level.kernel.begin(), level.kernel.end());
    const int groups = (size.height + kRowsAtATime - 1) / kRowsAtATime;
    ParallelFor(0, groups * static_cast<int>(frame.size()), [&](int task) {
      const auto c = static_cast<size_t>(task / groups);
      const int begin = task % groups * kRowsAtATime, end = std::min(begin + kRowsAtATime, size.height);
      HWY_DYNAMIC_DISPATCH(SmoothAndThin)(from[c], weights, step, begin, end, to[c]);
    });
  }
  return coarse;
}

}  // namespace shimmer::sim
#endif
