#include "restore/mask_grid.h"

#include <algorithm>
#include <cmath>

namespace shimmer::restore {
namespace {

// Neighbours above and below of cells that are numbered, and stretches of them.
void Connect(MaskGrid& grid, int32_t cells) {
  const size_t size = static_cast<size_t>(cells) + 2;
  for (auto* numbers : {&grid.up, &grid.down}) numbers->assign(size, 0);
  for (auto* values : {&grid.to_right, &grid.to_down, &grid.held, &grid.diagonal, &grid.inverse})
    values->assign(size, 0);
  int longest = 0;
  auto above = grid.runs.begin();
  for (const CellRun& run : grid.runs) {
    longest = std::max(longest, run.end - run.begin);
    while (above->y < run.y - 1 || (above->y == run.y - 1 && above->end <= run.begin)) ++above;
    for (auto over = above; over->y == run.y - 1 && over->begin < run.end; ++over)
      for (int x = std::max(over->begin, run.begin); x < std::min(over->end, run.end); ++x) {
        const int32_t upper = over->first + x - over->begin, lower = run.first + x - run.begin;
        grid.down[static_cast<size_t>(upper)] = lower;
        grid.up[static_cast<size_t>(lower)] = upper;
      }
  }
  grid.nothing.assign(static_cast<size_t>(longest), 0);
  for (const CellRun& run : grid.runs) {
    const int32_t last = run.first + run.end - run.begin;
    for (int32_t first = run.first; first < last;) {
      const int32_t up = grid.up[static_cast<size_t>(first)], down = grid.down[static_cast<size_t>(first)];
      const auto goes_on = [](const std::vector<int32_t>& numbers, int32_t cell, int32_t from, int32_t by) {
        return numbers[static_cast<size_t>(cell)] == (from == 0 ? 0 : from + by);
      };
      int32_t end = first + 1;
      while (end < last && goes_on(grid.up, end, up, end - first) &&
             goes_on(grid.down, end, down, end - first))
        ++end;
      grid.stretches.push_back({first, end - first, up, down});
      first = end;
    }
  }
}

void SetDiagonal(MaskGrid& grid) {
  for (size_t i = 1; i + 1 < grid.size(); ++i) {
    grid.diagonal[i] = grid.held[i] + grid.to_right[i] + grid.to_down[i] + grid.to_right[i - 1] +
                       grid.to_down[static_cast<size_t>(grid.up[i])];
    grid.inverse[i] = grid.diagonal[i] > 0 ? 1 / grid.diagonal[i] : 0;
  }
}

using Lanes = Sample4::Lanes;

// A stretch with its neighbours' values and weights, which are 0 where none are.
struct Beside {
  const Sample4 *up, *down;
  const float *to_up, *to_down;

  Beside(const MaskGrid& grid, const MaskGrid::Stretch& at, const CellValues& u)
      : up(u.data() + (at.up != 0 ? at.up : at.first)),
        down(u.data() + (at.down != 0 ? at.down : at.first)),
        to_up(at.up != 0 ? grid.to_down.data() + at.up : grid.nothing.data()),
        to_down(at.down != 0 ? grid.to_down.data() + at.first : grid.nothing.data()) {}
};

int32_t CoarseOf(const CellRun& run, const MaskGrid& coarse, size_t& at) {
  // Runs come in the order of their rows, two of which lie in one of the coarse ones.
  const auto contains = [&](const CellRun& over) {
    return over.y == run.y / 2 && over.begin <= run.begin / 2 && run.begin / 2 < over.end;
  };
  if (at > 0 && coarse.runs[at].y == run.y / 2 && coarse.runs[at].begin > run.begin / 2)
    while (at > 0 && coarse.runs[at - 1].y == run.y / 2) --at;
  while (!contains(coarse.runs[at])) ++at;
  return coarse.runs[at].first + run.begin / 2 - coarse.runs[at].begin;
}

// f(fine cell, half of its coarse cell, the same half of the coarse cell that is nearest above or below)
template <class F>
void ForHalves(const MaskGrid& fine, const MaskGrid& coarse, const F& f) {
  size_t at = 0;
  for (const CellRun& run : fine.runs) {
    const int32_t base = CoarseOf(run, coarse, at) - run.begin / 2;
    const int32_t* beside = run.y % 2 == 0 ? coarse.up.data() : coarse.down.data();
    for (int x = run.begin; x < run.end; ++x) {
      const int32_t cell = base + x / 2;
      f(run.first + x - run.begin, 2 * cell + x % 2, 2 * beside[cell] + x % 2);
    }
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
      grid.runs.push_back({y, static_cast<int>(begin - row), static_cast<int>(at - row), count + 1});
      count += static_cast<int32_t>(at - begin);
    }
  }
  Connect(grid, count);
  for (const CellRun& run : grid.runs)
    for (int x = run.begin; x < run.end; ++x) {
      const auto i = static_cast<size_t>(run.first + x - run.begin);
      grid.to_right[i] = x + 1 < run.end;
      grid.to_down[i] = grid.down[i] != 0;
      grid.held[i] =
          static_cast<float>((x == run.begin && x > 0) + (x + 1 == run.end && x + 1 < mask.cols) +
                             (grid.up[i] == 0 && run.y > 0) + (grid.down[i] == 0 && run.y + 1 < mask.rows));
    }
  SetDiagonal(grid);
  return grid;
}

MaskGrid Coarser(const MaskGrid& fine) {
  MaskGrid coarse;
  coarse.level = fine.level + 1;
  int width = 0;
  for (const CellRun& run : fine.runs) width = std::max(width, (run.end + 1) / 2);
  std::vector<uint8_t> there(static_cast<size_t>(width));  // of a row
  int32_t count = 0;
  for (auto first = fine.runs.begin(); first != fine.runs.end();) {
    const int y = first->y / 2;
    std::fill(there.begin(), there.end(), 0);
    for (; first != fine.runs.end() && first->y / 2 == y; ++first)
      std::fill(there.begin() + first->begin / 2, there.begin() + (first->end + 1) / 2, 1);
    for (int x = 0; x < width; ++x) {
      if (there[static_cast<size_t>(x)] == 0) continue;
      if (x == 0 || there[static_cast<size_t>(x) - 1] == 0) coarse.runs.push_back({y, x, x, count + 1});
      ++coarse.runs.back().end, ++count;
    }
  }
  Connect(coarse, count);
  // Two edges between squares that are twice as far apart: half of their sum. What holds the mask lies half a
  // px beyond its px, whatever the squares' size: 2^level edges at a distance of 2^level / 2 + 1/2.
  const auto hold = [](int level) { return 2 / (1 + std::ldexp(1.0f, -level)); };
  const float held = hold(coarse.level) / hold(fine.level) / 2;
  size_t at = 0;
  for (const CellRun& run : fine.runs) {
    const int32_t base = CoarseOf(run, coarse, at) - run.begin / 2;
    for (int x = run.begin; x < run.end; ++x) {
      const auto i = static_cast<size_t>(run.first + x - run.begin), own = static_cast<size_t>(base + x / 2);
      if (x % 2 == 1) coarse.to_right[own] += fine.to_right[i] / 2;
      if (run.y % 2 == 1) coarse.to_down[own] += fine.to_down[i] / 2;
      coarse.held[own] += fine.held[i] * held;
    }
  }
  SetDiagonal(coarse);
  return coarse;
}

void Pull(const MaskGrid& grid, const CellValues& u, CellValues& result) {
  for (const MaskGrid::Stretch& at : grid.stretches) {
    const Beside beside(grid, at, u);
    const Sample4* own = u.data() + at.first;
    const float *right = grid.to_right.data() + at.first, *diagonal = grid.diagonal.data() + at.first;
    for (int32_t k = 0; k < at.count; ++k)
      result[static_cast<size_t>(at.first + k)].v = right[k] * own[k + 1].v + right[k - 1] * own[k - 1].v +
                                                    beside.to_down[k] * beside.down[k].v +
                                                    beside.to_up[k] * beside.up[k].v - diagonal[k] * own[k].v;
  }
}

void FirstSweep(const MaskGrid& grid, const CellValues& b, CellValues& u, CellValues& rest) {
  for (const MaskGrid::Stretch& at : grid.stretches) {
    const Beside beside(grid, at, u);
    const float *right = grid.to_right.data() + at.first, *inverse = grid.inverse.data() + at.first;
    Lanes left = u[static_cast<size_t>(at.first) - 1].v;
    for (int32_t k = 0; k < at.count; ++k) {
      const auto i = static_cast<size_t>(at.first + k);
      u[i].v = left = (b[i].v + beside.to_up[k] * beside.up[k].v + right[k - 1] * left) * inverse[k];
    }
  }
  // The equations held when their cells were swept: what came later is left.
  for (const MaskGrid::Stretch& at : grid.stretches) {
    const Beside beside(grid, at, u);
    const Sample4* own = u.data() + at.first;
    const float* right = grid.to_right.data() + at.first;
    for (int32_t k = 0; k < at.count; ++k)
      rest[static_cast<size_t>(at.first + k)].v =
          right[k] * own[k + 1].v + beside.to_down[k] * beside.down[k].v;
  }
}

void SweepForward(const MaskGrid& grid, const CellValues& b, CellValues& u) {
  for (const MaskGrid::Stretch& at : grid.stretches) {
    const Beside beside(grid, at, u);
    const float* right = grid.to_right.data() + at.first;
    for (int32_t k = 0; k < at.count; ++k) {
      const auto i = static_cast<size_t>(at.first + k);
      u[i].v = (b[i].v + beside.to_up[k] * beside.up[k].v + beside.to_down[k] * beside.down[k].v +
                right[k] * u[i + 1].v + right[k - 1] * u[i - 1].v) *
               grid.inverse[i];
    }
  }
}

void SweepBack(const MaskGrid& grid, const CellValues& b, CellValues& u) {
  for (auto stretch = grid.stretches.rbegin(); stretch != grid.stretches.rend(); ++stretch) {
    const MaskGrid::Stretch& at = *stretch;
    const Beside beside(grid, at, u);
    const float* right = grid.to_right.data() + at.first;
    for (int32_t k = at.count - 1; k >= 0; --k) {
      const auto i = static_cast<size_t>(at.first + k);
      u[i].v = (b[i].v + beside.to_up[k] * beside.up[k].v + beside.to_down[k] * beside.down[k].v +
                right[k - 1] * u[i - 1].v + right[k] * u[i + 1].v) *
               grid.inverse[i];
    }
  }
}

void AddInterpolated(const MaskGrid& fine, const MaskGrid& coarse, const CellValues& from, CellValues& to,
                     CellValues& halves) {
  for (const CellRun& run : coarse.runs)
    for (int x = run.begin; x < run.end; ++x) {
      const auto i = static_cast<size_t>(run.first + x - run.begin);
      const Lanes own = 0.75f * from[i].v;
      halves[2 * i].v = x > run.begin ? own + 0.25f * from[i - 1].v : own;
      halves[2 * i + 1].v = x + 1 < run.end ? own + 0.25f * from[i + 1].v : own;
    }
  halves[0] = halves[1] = {};
  ForHalves(fine, coarse, [&](int32_t i, int32_t own, int32_t beside) {
    to[static_cast<size_t>(i)].v +=
        0.75f * halves[static_cast<size_t>(own)].v + 0.25f * halves[static_cast<size_t>(beside)].v;
  });
}

void Gather(const MaskGrid& fine, const MaskGrid& coarse, const CellValues& from, CellValues& to,
            CellValues& halves) {
  std::fill(halves.begin(), halves.end(), Sample4{});
  ForHalves(fine, coarse, [&](int32_t i, int32_t own, int32_t beside) {
    const Lanes value = from[static_cast<size_t>(i)].v;
    halves[static_cast<size_t>(own)].v += 0.75f * value;
    halves[static_cast<size_t>(beside)].v += 0.25f * value;
  });
  for (const CellRun& run : coarse.runs)
    for (int x = run.begin; x < run.end; ++x) {
      const auto i = static_cast<size_t>(run.first + x - run.begin);
      Lanes sum = 0.75f * (halves[2 * i].v + halves[2 * i + 1].v);
      if (x > run.begin) sum += 0.25f * halves[2 * i - 1].v;
      if (x + 1 < run.end) sum += 0.25f * halves[2 * i + 2].v;
      to[i].v = sum;
    }
}

}  // namespace shimmer::restore
