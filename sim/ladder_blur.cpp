#include "sim/ladder_blur.h"

#include <algorithm>
#include <array>

#include "sim/row_kernels.h"

namespace shimmer::sim {
namespace {

constexpr int kStretchPx = 256;   // of a row at a time: what it needs stays in the first cache
constexpr int kMostSpacing = 16;  // of a ladder up to 32 px; stretches begin at multiples of it

// Rows of floats, one a level, with room for a stretch and what rounding it up adds.
class LevelRows {
 public:
  explicit LevelRows(int levels) : floats_(static_cast<size_t>(levels) * kRow) {
    for (int k = 0; k < levels; ++k) rows_[k] = floats_.data() + static_cast<size_t>(k) * kRow;
  }
  float* const* rows() { return rows_.data(); }

 private:
  static constexpr size_t kRow = kStretchPx + 2 * kMostSpacing + kRowMultiple;
  std::vector<float> floats_;
  std::array<float*, kMostLevels> rows_{};
};

// A fine level's values: the whole kernel, down the columns and then along the row.
void FineRow(const cv::Mat& plane, const std::vector<float>& weights, int y, int x0, std::span<float> out,
             std::vector<float>& scratch) {
  const int radius = static_cast<int>(weights.size()) - 1;
  std::array<const float*, kMostFineTaps> before, after;
  const auto at = [&](int row) { return plane.ptr<float>(row) + x0 - radius; };
  for (int k = 1; k <= radius; ++k) before[k] = at(y - k), after[k] = at(y + k);
  scratch.resize(out.size() + 2 * static_cast<size_t>(radius));
  ConvolveRow(weights, at(y), before.data(), after.data(), scratch);
  const float* inside = scratch.data() + radius;
  for (int k = 1; k <= radius; ++k) before[k] = inside - k, after[k] = inside + k;
  ConvolveRow(weights, inside, before.data(), after.data(), out);
}

}  // namespace

LadderBlur::LadderBlur(const cv::Mat& frame, const LevelLadder& ladder) : ladder_(ladder), tables_(ladder) {
  cv::split(frame, planes_);
  for (const cv::Mat& plane : planes_) coarse_.push_back(CoarseLevels(plane, ladder));
  for (const BlurLevel& level : ladder.levels())
    fine_weights_.emplace_back(level.kernel.begin(), level.kernel.end());
}

void LadderBlur::Row(cv::Point first, std::span<const float> sigma_px, float* out) const {
  const int levels = static_cast<int>(ladder_.levels().size());
  const size_t channels = planes_.size();
  LevelRows weights(levels), values(levels);
  std::vector<float> sigma, mixed, scratch;

  for (size_t begin = 0; begin < sigma_px.size(); begin += kStretchPx) {
    const std::span<const float> stretch =
        sigma_px.subspan(begin, std::min<size_t>(kStretchPx, sigma_px.size() - begin));
    const uint32_t in_use = LevelsInUse(tables_, stretch);
    const int x = first.x + static_cast<int>(begin);
    const int skipped = x % kMostSpacing;  // px before the stretch, so that it begins on every grid
    const size_t padded =
        (stretch.size() + static_cast<size_t>(skipped) + kMostSpacing - 1) / kMostSpacing * kMostSpacing;

    sigma.assign(padded + kRowMultiple, stretch[0]);
    std::copy(stretch.begin(), stretch.end(), sigma.begin() + skipped);
    MixtureWeights(tables_, in_use, {sigma.data(), padded}, weights.rows());
    mixed.resize(padded);
    for (size_t c = 0; c < channels; ++c) {
      for (int k = 0; k < levels; ++k) {
        if (!(in_use >> k & 1)) continue;
        const std::span<float> row(values.rows()[k], padded);
        if (ladder_.levels()[k].spacing_px == 1)
          FineRow(planes_[c], fine_weights_[k], first.y, x - skipped, row, scratch);
        else
          CoarseRow(coarse_[c][k], first.y, x - skipped, row, scratch);
      }
      MixLevels(in_use, weights.rows(), values.rows(), mixed);
      for (size_t i = 0; i < stretch.size(); ++i) out[(begin + i) * channels + c] = mixed[i + skipped];
    }
  }
}

}  // namespace shimmer::sim
