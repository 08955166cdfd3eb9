#include "restore/mask_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace shimmer::restore {
namespace {

// Neighbours of cells that are numbered.
void Connect(MaskGrid& grid) {
  auto above = grid.runs.begin();
  for (const CellRun& run : grid.runs) {
    const int32_t count = run.end - run.begin;
    for (int32_t i = run.first; i + 1 < run.first + count; ++i) {
      grid.cells[static_cast<size_t>(i)].right = i + 1;
      grid.cells[static_cast<size_t>(i) + 1].left = i;
    }
    while (above->y < run.y - 1 || (above->y == run.y - 1 && above->end <= run.begin)) ++above;
    for (auto over = above; over->y == run.y - 1 && over->begin < run.end; ++over)
      for (int x = std::max(over->begin, run.begin); x < std::min(over->end, run.end); ++x) {
        const int32_t upper = over->first + x - over->begin, lower = run.first + x - run.begin;
        grid.cells[static_cast<size_t>(upper)].down = lower;
        grid.cells[static_cast<size_t>(lower)].up = upper;
      }
  }
}

const MaskGrid::Cell* At(const MaskGrid& grid, int32_t cell) {
  return cell == MaskGrid::kNone ? nullptr : &grid.cells[static_cast<size_t>(cell)];
}

void SetInverses(MaskGrid& grid) {
  for (MaskGrid::Cell& cell : grid.cells) {
    float sum = cell.held + cell.to_right + cell.to_down;
    if (const auto* left = At(grid, cell.left)) sum += left->to_right;
    if (const auto* up = At(grid, cell.up)) sum += up->to_down;
    cell.inverse = sum > 0 ? 1 / sum : 0;
  }
}

// sum_j w_ij u_j
Sample4::Lanes Pull(const MaskGrid& grid, const MaskGrid::Cell& cell, const std::vector<Sample4>& u) {
  Sample4::Lanes sum = {0, 0, 0, 0};
  if (cell.right >= 0) sum += cell.to_right * u[static_cast<size_t>(cell.right)].v;
  if (cell.down >= 0) sum += cell.to_down * u[static_cast<size_t>(cell.down)].v;
  if (cell.up >= 0)
    sum += grid.cells[static_cast<size_t>(cell.up)].to_down * u[static_cast<size_t>(cell.up)].v;
  if (cell.left >= 0)
    sum += grid.cells[static_cast<size_t>(cell.left)].to_right * u[static_cast<size_t>(cell.left)].v;
  return sum;
}

// f(fine cell, coarse cell, weight) for each pair that bilinear interpolation joins.
template <class F>
void ForPairs(const MaskGrid& fine, const MaskGrid& coarse, const F& f) {
  for (const CellRun& run : fine.runs)
    for (int x = run.begin; x < run.end; ++x) {
      const auto i = static_cast<size_t>(run.first + x - run.begin);
      const auto beside = [x](const MaskGrid::Cell* cell) {
        return cell == nullptr ? MaskGrid::kNone : x % 2 == 0 ? cell->left : cell->right;
      };
      const auto over = [y = run.y](const MaskGrid::Cell* cell) {
        return cell == nullptr ? MaskGrid::kNone : y % 2 == 0 ? cell->up : cell->down;
      };
      const int32_t own = fine.coarse[i];
      const int32_t along_x = beside(At(coarse, own)), along_y = over(At(coarse, own));
      int32_t both = over(At(coarse, along_x));
      if (both == MaskGrid::kNone) both = beside(At(coarse, along_y));
      f(i, static_cast<size_t>(own), 9 / 16.0f);
      if (along_x >= 0) f(i, static_cast<size_t>(along_x), 3 / 16.0f);
      if (along_y >= 0) f(i, static_cast<size_t>(along_y), 3 / 16.0f);
      if (both >= 0) f(i, static_cast<size_t>(both), 1 / 16.0f);
    }
}

}  // namespace

MaskGrid GridOf(const cv::Mat& mask) {
  MaskGrid grid;
  int32_t count = 0;
  for (int y = 0; y < mask.rows; ++y) {
    const auto* row = mask.ptr<uint8_t>(y);
    const auto* last = row + mask.cols;
    for (const auto* at = row; at != last;) {
      const auto* begin = std::find_if(at, last, [](uint8_t v) { return v != 0; });
      at = std::find(begin, last, uint8_t{0});
      if (begin == at) continue;
      grid.runs.push_back({y, static_cast<int>(begin - row), static_cast<int>(at - row), count});
      count += static_cast<int32_t>(at - begin);
    }
  }
  grid.cells.resize(static_cast<size_t>(count));
  Connect(grid);
  for (const CellRun& run : grid.runs)
    for (int x = run.begin; x < run.end; ++x) {
      MaskGrid::Cell& cell = grid.cells[static_cast<size_t>(run.first + x - run.begin)];
      cell.to_right = cell.right >= 0, cell.to_down = cell.down >= 0;
      const int on_frame = (x > 0) + (x + 1 < mask.cols) + (run.y > 0) + (run.y + 1 < mask.rows);
      const int in_mask = (cell.left >= 0) + (cell.right >= 0) + (cell.up >= 0) + (cell.down >= 0);
      cell.held = static_cast<float>(on_frame - in_mask);
    }
  SetInverses(grid);
  return grid;
}

MaskGrid Coarser(MaskGrid& fine) {
  MaskGrid coarse;
  coarse.level = fine.level + 1;
  fine.coarse.resize(fine.size());
  int width = 0;
  for (const CellRun& run : fine.runs) width = std::max(width, (run.end + 1) / 2);
  std::vector<int32_t> number(static_cast<size_t>(width) + 1, MaskGrid::kNone);  // of a row; the last is none
  int32_t count = 0;
  for (auto first = fine.runs.begin(); first != fine.runs.end();) {
    const int y = first->y / 2;
    const auto last =
        std::find_if(first, fine.runs.end(), [y](const CellRun& run) { return run.y / 2 != y; });
    for (auto run = first; run != last; ++run)
      std::fill(number.begin() + run->begin / 2, number.begin() + (run->end + 1) / 2, 0);
    for (size_t x = 0; x < number.size() - 1; ++x) {
      if (number[x] == MaskGrid::kNone) continue;
      if (x == 0 || number[x - 1] == MaskGrid::kNone)
        coarse.runs.push_back({y, static_cast<int>(x), static_cast<int>(x), count});
      number[x] = count++;
      ++coarse.runs.back().end;
    }
    for (auto run = first; run != last; ++run)
      for (int x = run->begin; x < run->end; ++x)
        fine.coarse[static_cast<size_t>(run->first + x - run->begin)] = number[static_cast<size_t>(x / 2)];
    std::fill(number.begin(), number.end(), MaskGrid::kNone);
    first = last;
  }
  coarse.cells.resize(static_cast<size_t>(count));
  Connect(coarse);
  // Two edges between squares that are twice as far apart: half of their sum. What holds the mask lies half a
  // px beyond its px, whatever the squares' size: 2^level edges at a distance of 2^level / 2 + 1/2.
  const auto hold = [](int level) { return 2 / (1 + std::ldexp(1.0f, -level)); };
  const float held = hold(coarse.level) / hold(fine.level) / 2;
  for (size_t i = 0; i < fine.size(); ++i) {
    const MaskGrid::Cell& cell = fine.cells[i];
    const int32_t own = fine.coarse[i];
    MaskGrid::Cell& into = coarse.cells[static_cast<size_t>(own)];
    if (cell.right >= 0 && fine.coarse[static_cast<size_t>(cell.right)] != own)
      into.to_right += cell.to_right / 2;
    if (cell.down >= 0 && fine.coarse[static_cast<size_t>(cell.down)] != own)
      into.to_down += cell.to_down / 2;
    into.held += cell.held * held;
  }
  SetInverses(coarse);
  return coarse;
}

void Residual(const MaskGrid& grid, const std::vector<Sample4>& b, const std::vector<Sample4>& u,
              std::vector<Sample4>& residual) {
  for (size_t i = 0; i < grid.size(); ++i) {
    const MaskGrid::Cell& cell = grid.cells[i];
    residual[i].v = b[i].v + Pull(grid, cell, u) - u[i].v / cell.inverse;
  }
}

void SweepForward(const MaskGrid& grid, const std::vector<Sample4>& b, std::vector<Sample4>& u) {
  for (size_t i = 0; i < grid.size(); ++i)
    u[i].v = (b[i].v + Pull(grid, grid.cells[i], u)) * grid.cells[i].inverse;
}

void SweepBack(const MaskGrid& grid, const std::vector<Sample4>& b, std::vector<Sample4>& u) {
  for (size_t i = grid.size(); i-- > 0;)
    u[i].v = (b[i].v + Pull(grid, grid.cells[i], u)) * grid.cells[i].inverse;
}

void AddInterpolated(const MaskGrid& fine, const MaskGrid& coarse, const std::vector<Sample4>& from,
                     std::vector<Sample4>& to) {
  ForPairs(fine, coarse, [&](size_t i, size_t j, float weight) { to[i].v += weight * from[j].v; });
}

void Gather(const MaskGrid& fine, const MaskGrid& coarse, const std::vector<Sample4>& from,
            std::vector<Sample4>& to) {
  std::fill(to.begin(), to.end(), Sample4{});
  ForPairs(fine, coarse, [&](size_t i, size_t j, float weight) { to[j].v += weight * from[i].v; });
}

}  // namespace shimmer::restore
