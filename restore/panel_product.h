// Products of a matrix and the panels of a row.
//
// Ours, as the matrices are small and one side needs no packing: on Zen 3 (AVX2, one thread, 16 to 1021
// columns, rows of 32 to 960 px) it does 31 to 45 GMAC/s where oneDNN 2.6 does 29 to 43 and OpenBLAS 0.3.21
// 17 to 37.
#pragma once

#include <vector>

#include "restore/panels.h"

namespace shimmer::restore {

// A left-hand matrix in tiles of rows, each with what a step of the product takes lying together:
// [tile][column][row of the tile]. Tiles have 6 rows or fewer, about alike: with two vectors of px their
// sums fill the registers.
class PackedMatrix {
 public:
  static constexpr int kMostTileRows = 6;

  PackedMatrix() = default;
  // values: rows, each of so many columns, row_stride floats apart, its columns column_stride.
  PackedMatrix(const float* values, int rows, int columns, size_t row_stride, size_t column_stride = 1);

  int Rows() const { return rows_; }
  int Columns() const { return columns_; }
  int Tiles() const { return (rows_ + kMostTileRows - 1) / kMostTileRows; }
  int TileBegin(int tile) const { return rows_ * tile / Tiles(); }
  const float* Tile(int tile) const {
    return values_.data() + static_cast<size_t>(TileBegin(tile)) * static_cast<size_t>(columns_);
  }

 private:
  int rows_ = 0, columns_ = 0;
  std::vector<float> values_;
};

// Where a row's channels are: px x of channel c at data[x / 16 * panel_stride + c * channel_stride + x % 16].
struct RowPlace {
  float* data = nullptr;
  size_t panel_stride = 0, channel_stride = 0;
};

// out = matrix * row (+ add, placed as out is, if it is not null) for px [begin, end) of the row, and the px
// that fill their vectors up. row: [panel][column of the matrix][16]. out and add may be the same.
void Multiply(const PackedMatrix& matrix, const float* row, int begin, int end, const RowPlace& out,
              const float* add = nullptr);

}  // namespace shimmer::restore
