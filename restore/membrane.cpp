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

using Numbers = std::array<double, 4>;

Numbers Dot(const CellValues& a, const CellValues& b) {
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

double Most(const CellValues& samples) {
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
      at_.push_back({CellValues(grid.size()), CellValues(grid.size()), CellValues(grid.size()),
                     CellValues(2 * grid.size())});
  }

  // The result holds until the next call.
  const CellValues& operator()(const CellValues& b) {
    Descend(0, b);
    return at_[0].u;
  }

 private:
  struct Level {
    CellValues u, b, rest, halves;
  };

  void Descend(size_t level, const CellValues& b) {
    const MaskGrid& grid = grids_[level];
    Level& at = at_[level];
    if (level + 1 == grids_.size()) {
      std::fill(at.u.begin(), at.u.end(), Sample4{});
      for (int sweep = 0; sweep < kLastSweeps; ++sweep) SweepForward(grid, b, at.u), SweepBack(grid, b, at.u);
      return;
    }
    FirstSweep(grid, b, at.u, at.rest);
    Level& coarse = at_[level + 1];
    Gather(grid, grids_[level + 1], at.rest, coarse.b, coarse.halves);
    Descend(level + 1, coarse.b);
    AddInterpolated(grid, grids_[level + 1], coarse.u, at.u, coarse.halves);
    SweepBack(grid, b, at.u);
  }

  const std::vector<MaskGrid>& grids_;
  std::vector<Level> at_;
};

}  // namespace

Membrane::Membrane(const cv::Mat& inside) : frame_({0, 0}, inside.size()) {
  if (inside.type() != CV_8UC1) throw std::invalid_argument("Membrane: inside must be CV_8UC1");
  levels_.push_back(GridOf(inside));
  while (levels_.back().cells() > kFewCells) {
    MaskGrid coarser = Coarser(levels_.back());
    if (coarser.size() == levels_.back().size()) break;  // px that do not touch one another
    levels_.push_back(std::move(coarser));
  }
}

CellValues Membrane::Solve(const std::function<Sample4(cv::Point)>& around, double tolerance) const {
  const MaskGrid& grid = levels_.front();
  // What the px around give, and their mean: only what differs from it is left to be solved.
  CellValues b(grid.size());
  Numbers sum{};
  double count = 0;
  for (const CellRun& run : grid.runs)
    for (int x = run.begin; x < run.end; ++x) {
      const auto i = static_cast<size_t>(run.first + x - run.begin);
      if (grid.held[i] == 0) continue;
      const auto add = [&](bool is_cell, cv::Point px) {
        if (is_cell || !frame_.contains(px)) return;
        const Sample4 value = around(px);
        b[i].v += value.v;
        for (size_t c = 0; c < 4; ++c) sum[c] += static_cast<double>(value.v[c]);
        ++count;
      };
      add(x > run.begin, {x - 1, run.y});
      add(x + 1 < run.end, {x + 1, run.y});
      add(grid.up[i] != 0, {x, run.y - 1});
      add(grid.down[i] != 0, {x, run.y + 1});
    }
  const Sample4 mean = Ratio(sum, {count, count, count, count});
  CellValues u(grid.size(), mean);
  if (count == 0) return u;
  for (size_t i = 1; i + 1 < grid.size(); ++i) b[i].v -= grid.held[i] * mean.v;

  Cycle cycle(levels_);
  CellValues step(grid.size()), pull(grid.size());
  Numbers before{};
  for (int k = 0; k < kMostSteps; ++k) {  // b is what is left
    const CellValues& towards = cycle(b);
    const Numbers now = Dot(b, towards);
    const Sample4 keep = Ratio(now, before);
    for (size_t i = 0; i < grid.size(); ++i) step[i].v = towards[i].v + keep.v * step[i].v;
    Pull(grid, step, pull);
    Numbers along = Dot(step, pull);
    for (double& value : along) value = -value;
    const Sample4 length = Ratio(now, along);
    for (size_t i = 0; i < grid.size(); ++i) {
      u[i].v += length.v * step[i].v;
      b[i].v += length.v * pull[i].v;
    }
    before = now;
    if (Most(towards) <= 2 * tolerance) break;  // with this step taken, far less is left
  }
  return u;
}

}  // namespace shimmer::restore
