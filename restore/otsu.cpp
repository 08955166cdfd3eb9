#include "restore/otsu.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace shimmer::restore {

PooledHistogram::PooledHistogram(double most, int bins)
    : width_(most / bins), counts_(static_cast<size_t>(std::max(bins, 1))) {
  if (bins < 2 || !(most > 0)) throw std::invalid_argument("PooledHistogram: bins >= 2 and most > 0");
}

void PooledHistogram::Add(const cv::Mat& values, const cv::Mat& use) {
  CV_Assert(values.type() == CV_32FC1 && use.type() == CV_8UC1 && values.size() == use.size());
  const double last = static_cast<double>(counts_.size() - 1);
  for (int y = 0; y < values.rows; ++y) {
    const auto* value = values.ptr<float>(y);
    const auto* used = use.ptr<uint8_t>(y);
    for (int x = 0; x < values.cols; ++x)
      if (used[x] != 0 && std::isfinite(value[x]))
        ++counts_[static_cast<size_t>(std::clamp(value[x] / width_, 0.0, last))];
  }
}

int64_t PooledHistogram::Count() const { return std::reduce(counts_.begin(), counts_.end()); }

double PooledHistogram::OtsuThreshold() const {
  double all = 0, sum = 0;
  for (size_t i = 0; i < counts_.size(); ++i) {
    all += static_cast<double>(counts_[i]);
    sum += static_cast<double>(i) * static_cast<double>(counts_[i]);
  }
  double below = 0, sum_below = 0, best = 0, edges = 0;
  int count = 0;
  for (size_t i = 0; i + 1 < counts_.size(); ++i) {
    below += static_cast<double>(counts_[i]);
    sum_below += static_cast<double>(i) * static_cast<double>(counts_[i]);
    const double above = all - below;
    if (below == 0 || above == 0) continue;
    const double apart = sum_below / below - (sum - sum_below) / above;
    const double between = below * above * apart * apart;
    if (between > best) best = between, edges = 0, count = 0;
    if (between == best) edges += static_cast<double>(i + 1), ++count;
  }
  return count == 0 ? 0 : edges / count * width_;
}

double PooledHistogram::Quantile(double part) const {
  const double wanted = part * static_cast<double>(Count());
  double below = 0;
  if (wanted <= 0) return 0;
  for (size_t i = 0; i < counts_.size(); ++i)
    if ((below += static_cast<double>(counts_[i])) >= wanted) return static_cast<double>(i + 1) * width_;
  return 0;
}

}  // namespace shimmer::restore
