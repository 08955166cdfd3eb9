#include "restore/block_shift.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "restore/mosaic.h"

namespace shimmer::restore {
namespace {

// Detail is smoothed, so that neighbours share their noise: so many px count as one.
constexpr double kPxOfOneSample = 12;
constexpr double kLeastAlike = 0.5;  // correlation of a block with its reference
constexpr double kTexture = 0.1;  // mean square of a block's detail, which is about 1 where there is texture
// Narrower than the 4.685 of 95 % efficiency: objects are on one side, and often nearer than the farthest
// air.
constexpr double kTukey = 3;
constexpr double kMadOfNormal = 0.4549;  // median of the square of a normal number
constexpr double kLeastScatter_px = 0.005;
constexpr double kMostShift_px = 4;  // beyond it the gradient says nothing
constexpr int kRounds = 12;
// Calibrated on clips under strong turbulence: of 1080p frames 99 % are within it, of 320x240 ones 93 %.
constexpr double kSure = 4;
constexpr int kTilesX = 4, kTilesY = 3;  // of a frame

// Sums over a block's px, one for each of its columns.
struct ColumnSums {
  std::array<float, kBlock_px> xx{}, xy{}, yy{}, xr{}, yr{}, rr{}, ff{}, mm{}, n{};
};

double Total(const std::array<float, kBlock_px>& columns) {
  double sum = 0;
  for (const float column : columns) sum += column;
  return sum;
}

void AddRow(const cv::Mat& frame, const cv::Mat& reference, const cv::Mat& seen, int x0, int y, int width,
            ColumnSums& sums) {
  const float *f = frame.ptr<float>(y) + x0, *f_up = frame.ptr<float>(y - 1) + x0,
              *f_down = frame.ptr<float>(y + 1) + x0, *r = reference.ptr<float>(y) + x0,
              *r_up = reference.ptr<float>(y - 1) + x0, *r_down = reference.ptr<float>(y + 1) + x0,
              *s = seen.ptr<float>(y) + x0, *s_up = seen.ptr<float>(y - 1) + x0,
              *s_down = seen.ptr<float>(y + 1) + x0;
  for (int x = 0; x < width; ++x) {
    const float least = std::min(std::min(s[x - 1], s[x + 1]), std::min(s_up[x], s_down[x]));
    const float counts = least > 0 ? 1.0f : 0.0f;
    // Both gradients' mean: an error of each alone would shorten the shift.
    const float gx = counts * 0.25f * (f[x + 1] - f[x - 1] + r[x + 1] - r[x - 1]);
    const float gy = counts * 0.25f * (f_down[x] - f_up[x] + r_down[x] - r_up[x]);
    const float rest = counts * (r[x] - f[x]);
    sums.xx[x] += gx * gx, sums.xy[x] += gx * gy, sums.yy[x] += gy * gy;
    sums.xr[x] += gx * rest, sums.yr[x] += gy * rest, sums.rr[x] += rest * rest;
    sums.ff[x] += counts * f[x] * f[x], sums.mm[x] += counts * r[x] * r[x], sums.n[x] += counts;
  }
}

void AddBlock(const ColumnSums& sums, cv::Point at, FrameBlocks& blocks) {
  const double n = Total(sums.n);
  if (n < kBlock_px * kBlock_px / 4.0) return;
  const double xx = Total(sums.xx), xy = Total(sums.xy), yy = Total(sums.yy), xr = Total(sums.xr),
               yr = Total(sums.yr), rr = Total(sums.rr);
  const double ff = Total(sums.ff), mm = Total(sums.mm), product = (ff + mm - rr) / 2,
               alike = product / std::max(std::sqrt(ff * mm), 1e-30);
  if (ff > kTexture * n) ++blocks.textured;
  if (alike < kLeastAlike) return;
  const double middle = (xx + yy) / 2, spread = std::hypot((xx - yy) / 2, xy);
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  const std::array<cv::Point2d, 2> axes = {cv::Point2d{std::cos(angle), std::sin(angle)},
                                           cv::Point2d{-std::sin(angle), std::cos(angle)}};
  const std::array<double, 2> strengths = {middle + spread, middle - spread};
  std::array<double, 2> shifts{};
  double unexplained = rr;
  for (size_t i = 0; i < 2; ++i) {
    const double along = axes[i].x * xr + axes[i].y * yr;
    if (strengths[i] <= 1e-9 * n) continue;
    shifts[i] = along / strengths[i];
    unexplained -= along * shifts[i];
  }
  const double variance = std::max(unexplained, 1e-6 * rr) / n * kPxOfOneSample;
  for (size_t i = 0; i < 2; ++i) {
    if (strengths[i] <= 1e-9 * n) continue;
    blocks.shifts.push_back({cv::Point2f(axes[i]), std::clamp(shifts[i], -kMostShift_px, kMostShift_px),
                             variance / strengths[i], at, ff > kTexture * n});
  }
}

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double Along(const BlockShift& block, cv::Point2d shift) {
  return block.axis.x * shift.x + block.axis.y * shift.y;
}

// Tukey's.
double WeightOf(const BlockShift& block, cv::Point2d shift, double scatter2) {
  const double variance = block.noise_px2 + scatter2;
  const double rest = block.shift_px - Along(block, shift);
  const double far = rest * rest / (variance * kTukey * kTukey);
  return far < 1 ? (1 - far) * (1 - far) / variance : 0;
}

// The weighted residuals of a tile are summed before they are squared (the cluster-robust covariance), since
// neighbours lie in the same air. How much that is more than the error of blocks taken as independent tells
// how far the air reaches: the error is taken to grow as much again from a tile to the frame.
double ErrorOf(const FrameBlocks& blocks, cv::Point2d shift, double scatter2) {
  cv::Matx22d sums = cv::Matx22d::zeros(), of_blocks = sums, of_tiles = sums;
  std::array<cv::Vec2d, kTilesX * kTilesY> tiles{};
  for (const BlockShift& block : blocks.shifts) {
    const double weight = WeightOf(block, shift, scatter2);
    const cv::Vec2d axis(block.axis.x, block.axis.y),
        rest = weight * (block.shift_px - Along(block, shift)) * axis;
    sums += weight * (axis * axis.t());
    of_blocks += rest * rest.t();
    const int tile =
        block.at.y * kTilesY / blocks.frame.height * kTilesX + block.at.x * kTilesX / blocks.frame.width;
    tiles[static_cast<size_t>(tile)] += rest;
  }
  for (const cv::Vec2d& tile : tiles) of_tiles += tile * tile.t();
  const cv::Matx22d inverse = sums.inv();
  const auto error = [&](const cv::Matx22d& squares) {
    return std::sqrt(std::max(cv::trace(inverse * squares * inverse), 1e-12));
  };
  const double alone = error(of_blocks), together = std::max(error(of_tiles), alone);
  return kSure * together * together / alone;
}

double AgreeingOf(const FrameBlocks& blocks, cv::Point2d shift, double scatter2) {
  int agreeing = 0;
  const std::vector<BlockShift>& all = blocks.shifts;
  for (size_t i = 0; i < all.size();) {
    const size_t first = i;
    bool agrees = true;
    for (; i < all.size() && all[i].at == all[first].at; ++i)
      agrees = agrees && WeightOf(all[i], shift, scatter2) > 0;
    agreeing += agrees && all[first].textured;
  }
  return blocks.textured > 0 ? static_cast<double>(agreeing) / blocks.textured : 0;
}

}  // namespace

FrameBlocks BlockShifts(const cv::Mat& frame, const cv::Mat& reference, const cv::Mat& seen) {
  constexpr int kRim = Mosaic::kRim_px;
  static_assert(kRim >= 1);  // neighbours are there
  const int rows = std::max(0, (frame.rows - 2 * kRim + kBlock_px - 1) / kBlock_px);
  std::vector<FrameBlocks> of_rows(static_cast<size_t>(rows));
  tbb::parallel_for(0, rows, [&](int row) {
    const int y0 = kRim + row * kBlock_px, end = std::min(y0 + kBlock_px, frame.rows - kRim);
    for (int x0 = kRim; x0 < frame.cols - kRim; x0 += kBlock_px) {
      const int width = std::min(kBlock_px, frame.cols - kRim - x0);
      ColumnSums sums;
      for (int y = y0; y < end; ++y) AddRow(frame, reference, seen, x0, y, width, sums);
      AddBlock(sums, {x0, y0}, of_rows[static_cast<size_t>(row)]);
    }
  });
  FrameBlocks blocks{.frame = frame.size(), .shifts = {}};  // in order, however many threads there were
  for (const FrameBlocks& row : of_rows) {
    blocks.shifts.insert(blocks.shifts.end(), row.shifts.begin(), row.shifts.end());
    blocks.textured += row.textured;
  }
  return blocks;
}

CommonShift CommonShiftOf(const FrameBlocks& blocks) {
  CommonShift common;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  common.shift_px = {kNaN, kNaN};
  if (blocks.shifts.empty()) return common;
  std::vector<double> noises;
  for (const BlockShift& block : blocks.shifts) noises.push_back(block.noise_px2);
  const double median_noise = MedianOf(noises);
  cv::Point2d shift;
  double scatter2 = 1;  // of the blocks that are measured well; wide at first
  for (int round = 0; round < kRounds; ++round) {
    cv::Matx22d sums = cv::Matx22d::zeros();
    cv::Vec2d along;
    for (const BlockShift& block : blocks.shifts) {
      const double weight = WeightOf(block, shift, scatter2);
      const cv::Vec2d axis(block.axis.x, block.axis.y);
      sums += weight * (axis * axis.t());
      along += weight * block.shift_px * axis;
    }
    const double determinant = cv::determinant(sums), trace = sums(0, 0) + sums(1, 1);
    if (!(determinant > 1e-9 * trace * trace)) return common;
    const cv::Vec2d now = sums.inv() * along;
    const bool still = round > 2 && cv::norm(cv::Point2d(now) - shift) < 1e-4;
    shift = cv::Point2d(now);
    std::vector<double> squares;
    for (const BlockShift& block : blocks.shifts)
      if (block.noise_px2 <= median_noise) {
        const double rest = block.shift_px - Along(block, shift);
        squares.push_back(rest * rest);
      }
    scatter2 = std::max(MedianOf(squares) / kMadOfNormal, kLeastScatter_px * kLeastScatter_px);
    common = {shift, std::sqrt(scatter2)};
    if (still) break;
  }
  common.error_px = ErrorOf(blocks, shift, scatter2);
  common.agreeing = AgreeingOf(blocks, shift, scatter2);
  return common;
}

}  // namespace shimmer::restore
