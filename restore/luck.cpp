#include "restore/luck.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "restore/levels.h"

namespace shimmer::restore {
namespace {

constexpr int kRows = 64;
constexpr int kSoftSide_px = 7, kReachSide_px = 7;                    // of the Gaussians' windows
constexpr int kAround_px = kSoftSide_px / 2 + 1 + kReachSide_px / 2;  // rows that a row's luck depends on
constexpr int kReduced = 4;
constexpr double kSpreadReach_px = 12, kSpreadFloor = 1;
constexpr size_t kLeastFrames = 4;
constexpr float kLeastDetail_octaves = 3;

cv::Mat Luma(const cv::Mat& rows) {
  cv::Mat levels, grey;
  rows.convertTo(levels, CV_32F, 255 / WhiteOf(rows.depth()));
  if (levels.channels() == 1) return levels;
  cv::cvtColor(levels, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

cv::Mat SquaredDetail(const cv::Mat& rows) {
  cv::Mat soft, detail;
  cv::GaussianBlur(Luma(rows), soft, {kSoftSide_px, kSoftSide_px}, kLuckSoft_px, kLuckSoft_px,
                   cv::BORDER_REPLICATE);
  cv::Laplacian(soft, detail, CV_32F, 1, 1, 0, cv::BORDER_REPLICATE);
  return detail.mul(detail);
}

// A float's exponent and the first three bits behind its point are the eighths of an octave of its logarithm.
uint8_t EighthsOfAnOctave(float energy) {
  constexpr int64_t kOfOne = 127 << 3;
  return static_cast<uint8_t>(
      std::clamp<int64_t>(int64_t{std::bit_cast<uint32_t>(energy) >> 20} - kOfOne, 0, 255));
}

// The value that so much of them (sorted) is below, between two where it falls there.
float Quantile(const std::vector<float>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(at);
  const float next = sorted[std::min(below + 1, sorted.size() - 1)];
  return sorted[below] + static_cast<float>(at - static_cast<double>(below)) * (next - sorted[below]);
}

float MedianOf(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

cv::Mat LuckOf(const cv::Mat& frame) {
  RequireFrame(frame, "frame");
  cv::Mat luck(frame.size(), CV_8UC1);
  tbb::parallel_for(0, (frame.rows + kRows - 1) / kRows, [&](int band) {
    const cv::Range rows(band * kRows, std::min((band + 1) * kRows, frame.rows));
    const cv::Range seen(std::max(rows.start - kAround_px, 0), std::min(rows.end + kAround_px, frame.rows));
    cv::Mat energy;
    cv::GaussianBlur(SquaredDetail(frame.rowRange(seen)), energy, {kReachSide_px, kReachSide_px},
                     kLuckReach_px, kLuckReach_px, cv::BORDER_REPLICATE);
    for (int y = rows.start; y < rows.end; ++y) {
      const auto* from = energy.ptr<float>(y - seen.start);
      auto* to = luck.ptr<uint8_t>(y);
      for (int x = 0; x < frame.cols; ++x)
        to[x] = EighthsOfAnOctave(std::max(from[x], 0.0f) + static_cast<float>(kLuckFloor));
    }
  });
  return luck;
}

void LuckSpread::Add(const cv::Mat& frame, const cv::Mat& hidden) {
  RequireFrame(frame, "frame");
  const cv::Size small(std::max(frame.cols / kReduced, 1), std::max(frame.rows / kReduced, 1));
  cv::Mat energy, octaves, hidden_there;
  cv::resize(SquaredDetail(frame), energy, small, 0, 0, cv::INTER_AREA);
  cv::GaussianBlur(energy, energy, {}, kSpreadReach_px / kReduced, 0, cv::BORDER_REPLICATE);
  cv::log(cv::max(energy, 0) + kSpreadFloor, octaves);
  octaves *= 1 / std::log(2.0);
  cv::resize(hidden, hidden_there, small, 0, 0, cv::INTER_AREA);
  octaves.setTo(std::numeric_limits<float>::quiet_NaN(), hidden_there > 0);
  energies_.push_back(octaves);
}

double LuckSpread::Octaves() const {
  if (energies_.size() < kLeastFrames) return 0;
  std::vector<float> details, spreads, of_px;
  for (int i = 0; i < static_cast<int>(energies_[0].total()); ++i) {
    of_px.clear();
    for (const cv::Mat& energy : energies_)
      if (const float octaves = energy.ptr<float>()[i]; !std::isnan(octaves)) of_px.push_back(octaves);
    if (of_px.size() < kLeastFrames) continue;
    std::ranges::sort(of_px);
    details.push_back(Quantile(of_px, 0.5));
    spreads.push_back(Quantile(of_px, 0.9) - Quantile(of_px, 0.1));
  }
  if (details.empty()) return 0;
  const float least = std::max(MedianOf(details), kLeastDetail_octaves);
  std::vector<float> of_detail;
  for (size_t i = 0; i < details.size(); ++i)
    if (details[i] >= least) of_detail.push_back(spreads[i]);
  return of_detail.empty() ? 0 : MedianOf(of_detail);
}

}  // namespace shimmer::restore
