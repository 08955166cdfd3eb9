#include "restore/membrane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace shimmer::restore {
namespace {

constexpr size_t kFewCells = 32;  // that sweeps alone solve
constexpr int kLastSweeps = 8;    // there and back
constexpr int kMostSteps = 100;   // a mask that needs more than 10 was not found

using Samples = std::vector<Sample4>;
using Numbers = std::array<double, 4>;

Numbers Dot(const Samples& a, const Samples& b) {
  constexpr size_t kAtOnce = 512;  // in float: long sums in double
  Numbers sum{};
  for (size_t first = 0; first < a.size(); first += kAtOnce) {
    Sample4 part;
    for (size_t i = first; i < std::min(first + kAtOnce, a.size()); ++i) part.v += a[i].v * b[i].v;
    for (size_t c = 0; c < sum.size(); ++c) sum[c] += static_cast<double>(part.v[c]);
  }
  return sum;
}

Sample4 Ratio(const Numbers& a, const Numbers& b) {
  Sample4 ratio;
  for (size_t c = 0; c < a.size(); ++c) ratio.v[c] = b[c] > 0 ? static_cast<float>(a[c] / b[c]) : 0;
  return ratio;
}

double Most(const Samples& samples) {
  float most = 0;
  for (const Sample4& sample : samples)
    for (size_t c = 0; c < 4; ++c) most = std::max(most, std::abs(sample.v[c]));
  return static_cast<double>(most);
}

// What one cycle through the grids takes for the solution of A u = b: a symmetric approximation.
class Cycle {
 public:
  explicit Cycle(const std::vector<MaskGrid>& grids) : grids_(grids) {
    for (const MaskGrid& grid : grids)
      at_.push_back({Samples(grid.size()), Samples(grid.size()), Samples(grid.size())});
  }

  // The result holds until the next call.
  const Samples& operator()(const Samples& b) {
    Descend(0, b);
    return at_[0].u;
  }

 private:
  struct Level {
    Samples u, b, rest;
  };

  void Descend(size_t level, const Samples& b) {
    const MaskGrid& grid = grids_[level];
    Level& at = at_[level];
    std::fill(at.u.begin(), at.u.end(), Sample4{});
    if (level + 1 == grids_.size()) {
      for (int sweep = 0; sweep < kLastSweeps; ++sweep) SweepForward(grid, b, at.u), SweepBack(grid, b, at.u);
      return;
    }
    SweepForward(grid, b, at.u);
    Residual(grid, b, at.u, at.rest);
    Gather(grid, grids_[level + 1], at.rest, at_[level + 1].b);
    Descend(level + 1, at_[level + 1].b);
    AddInterpolated(grid, grids_[level + 1], at_[level + 1].u, at.u);
    SweepBack(grid, b, at.u);
  }

  const std::vector<MaskGrid>& grids_;
  std::vector<Level> at_;
};

}  // namespace

Membrane::Membrane(const cv::Mat& inside) : frame_({0, 0}, inside.size()) {
  if (inside.type() != CV_8UC1) throw std::invalid_argument("Membrane: inside must be CV_8UC1");
  levels_.push_back(GridOf(inside));
  while (levels_.back().size() > kFewCells) {
    MaskGrid coarser = Coarser(levels_.back());
    if (coarser.size() == levels_.back().size()) break;  // px that do not touch one another
    levels_.push_back(std::move(coarser));
  }
}

std::vector<Sample4> Membrane::Solve(const std::function<Sample4(cv::Point)>& around,
                                     double tolerance) const {
  const MaskGrid& grid = levels_.front();
  // What the px around give, and their mean: only what differs from it is left to be solved.
  Samples b(grid.size());
  Numbers sum{};
  double count = 0;
  for (const CellRun& run : grid.runs)
    for (int x = run.begin; x < run.end; ++x) {
      const auto i = static_cast<size_t>(run.first + x - run.begin);
      const MaskGrid::Cell& cell = grid.cells[i];
      if (cell.held == 0) continue;
      const std::array<std::pair<int32_t, cv::Point>, 4> sides = {
          std::pair(cell.left, cv::Point(x - 1, run.y)),
          {cell.right, {x + 1, run.y}},
          {cell.up, {x, run.y - 1}},
          {cell.down, {x, run.y + 1}}};
      for (const auto& [neighbour, px] : sides) {
        if (neighbour != MaskGrid::kNone || !frame_.contains(px)) continue;
        const Sample4 value = around(px);
        b[i].v += value.v;
        for (size_t c = 0; c < 4; ++c) sum[c] += static_cast<double>(value.v[c]);
        ++count;
      }
    }
  const Sample4 mean = Ratio(sum, {count, count, count, count});
  Samples u(grid.size(), mean);
  if (count == 0) return u;
  for (size_t i = 0; i < grid.size(); ++i) b[i].v -= grid.cells[i].held * mean.v;

  Cycle cycle(levels_);
  Samples step(grid.size()), pull(grid.size());
  const Samples zero(grid.size());
  Numbers before{};
  for (int k = 0; k < kMostSteps; ++k) {  // b is what is left
    const Samples& towards = cycle(b);
    const Numbers now = Dot(b, towards);
    const Sample4 keep = Ratio(now, before);
    for (size_t i = 0; i < grid.size(); ++i) step[i].v = towards[i].v + keep.v * step[i].v;
    Residual(grid, zero, step, pull);  // -A step
    Numbers along = Dot(step, pull);
    for (double& value : along) value = -value;
    const Sample4 length = Ratio(now, along);
    for (size_t i = 0; i < grid.size(); ++i) {
      u[i].v += length.v * step[i].v;
      b[i].v += length.v * pull[i].v;
    }
    before = now;
    if (Most(towards) <= tolerance) break;
  }
  return u;
}

}  // namespace shimmer::restore
