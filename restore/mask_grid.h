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

// Cells [begin, end) of row y; they are cells first, first + 1, ... of the grid.
struct CellRun {
  int y, begin, end;
  int32_t first;
};

// Cells in the order of their runs, rows from the top. Beside each its neighbours and how strongly they pull:
// the weights of the matrix A with (A u)_i = sum_j w_ij (u_i - u_j) + held_i u_i, symmetric and positive.
struct MaskGrid {
  static constexpr int32_t kNone = -1;
  struct Cell {
    int32_t left = kNone, right = kNone, up = kNone, down = kNone;
    float to_right = 0, to_down = 0;  // weights
    float held = 0;                   // by what lies around the mask
    float inverse = 0;                // 1 / A_ii
  };
  std::vector<CellRun> runs;
  std::vector<Cell> cells;
  std::vector<int32_t> coarse;  // of each cell: the cell of the next coarser grid that it lies in
  int level = 0;                // cells are 2^level px wide

  size_t size() const { return cells.size(); }
};

// The px of a mask that are not 0. mask: CV_8UC1. Weights 1; held by each neighbour on the frame, but outside
// of the mask.
MaskGrid GridOf(const cv::Mat& mask);

// Squares of 2 x 2 cells, of which one at least is there. Weights as the finite volumes of such squares have
// them. Sets fine.coarse.
MaskGrid Coarser(MaskGrid& fine);

// A u - with u and b by cells: residual = b - A u.
void Residual(const MaskGrid& grid, const std::vector<Sample4>& b, const std::vector<Sample4>& u,
              std::vector<Sample4>& residual);

// One sweep of Gauss-Seidel from the first cell to the last, or back.
void SweepForward(const MaskGrid& grid, const std::vector<Sample4>& b, std::vector<Sample4>& u);
void SweepBack(const MaskGrid& grid, const std::vector<Sample4>& b, std::vector<Sample4>& u);

// Bilinear interpolation to the finer grid, added to what is there; and its transpose. Cells that are not
// there count as 0.
void AddInterpolated(const MaskGrid& fine, const MaskGrid& coarse, const std::vector<Sample4>& from,
                     std::vector<Sample4>& to);
void Gather(const MaskGrid& fine, const MaskGrid& coarse, const std::vector<Sample4>& from,
            std::vector<Sample4>& to);

}  // namespace shimmer::restore
