// What a mask covers as a grid of cells that hang together: the px, or squares of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace shimmer::restore {

// Four channels that are computed with at once.
struct Sample4 {
  using Lanes = float __attribute__((vector_size(16)));
  Lanes v = {0, 0, 0, 0};
};

// Of each cell, by its number. 0 and the one after the last are no cells, and are 0.
using CellValues = std::vector<Sample4>;

// Cells [begin, end) of row y, numbered first, first + 1, ...
struct CellRun {
  int y, begin, end;
  int32_t first;
};

// Cells are numbered from 1, in the order of their runs, rows from the top. Neighbours pull one another: the
// matrix A with (A u)_i = sum_j w_ij (u_i - u_j) + held_i u_i, symmetric and positive.
struct MaskGrid {
  // Cells of one run of which the neighbours above are numbered on too, and those below; 0 if there are none.
  struct Stretch {
    int32_t first, count, up, down;
  };
  std::vector<CellRun> runs;
  std::vector<Stretch> stretches;
  std::vector<int32_t> up, down;         // neighbours of each cell; 0: none
  std::vector<float> to_right, to_down;  // w of a cell and its neighbour on that side; 0: none
  std::vector<float> held;               // by what lies around the mask
  std::vector<float> diagonal, inverse;  // A_ii and 1 / A_ii
  std::vector<float> nothing;            // weights of neighbours that are not there
  int level = 0;                         // cells are 2^level px wide

  size_t size() const { return inverse.size(); }  // of CellValues
  size_t cells() const { return size() - 2; }
};

// The px of a mask that are not 0. mask: CV_8UC1. Weights 1; held by each neighbour that is on the frame and
// outside of the mask.
MaskGrid GridOf(const cv::Mat& mask);

// Squares of 2 x 2 cells, of which one at least is there. Weights as the finite volumes of such squares have
// them.
MaskGrid Coarser(const MaskGrid& fine);

// result = -A u.
void Pull(const MaskGrid& grid, const CellValues& u, CellValues& result);

// A sweep of Gauss-Seidel over A u = b from the first cell to the last, where u was 0, and what of b is left.
void FirstSweep(const MaskGrid& grid, const CellValues& b, CellValues& u, CellValues& rest);

// Sweeps over A u = b from the first cell to the last, and back.
void SweepForward(const MaskGrid& grid, const CellValues& b, CellValues& u);
void SweepBack(const MaskGrid& grid, const CellValues& b, CellValues& u);

// Bilinear interpolation of a coarser grid's values, added to what is there; and its transpose. Cells that
// are not there count as 0. halves: room for two values a coarse cell.
void AddInterpolated(const MaskGrid& fine, const MaskGrid& coarse, const CellValues& from, CellValues& to,
                     CellValues& halves);
void Gather(const MaskGrid& fine, const MaskGrid& coarse, const CellValues& from, CellValues& to,
            CellValues& halves);

}  // namespace shimmer::restore
