#include "restore/convolution.h"

#include <tbb/parallel_for.h>

#include <cstring>

#include "restore/row_tiles.h"

namespace shimmer::restore {
namespace {

// The three columns that a px takes of a row, as three times the channels: to is
// [panel][column][channel][16].
void TakeColumns(const Panels& image, int y, const RowTile& tile, float* to) {
  const size_t stride = image.PanelStride();
  const int width = image.Size().width;
  for (size_t panel = tile.first_panel; panel < tile.end_panel; ++panel) {
    const float* from = image.At(y, static_cast<ptrdiff_t>(panel));
    float *left = to + (panel - tile.first_panel) * 3 * stride, *here = left + stride, *right = here + stride;
    const bool first = panel == 0, last = panel + 1 == image.RowPanels();
    const size_t end = last ? static_cast<size_t>(width) - panel * kPanelPx : kPanelPx;  // px inside
    for (size_t at = 0; at < stride; at += kPanelPx) {
      std::memcpy(left + at + 1, from + at, (kPanelPx - 1) * sizeof(float));
      left[at] = first ? 0 : from[at + kPanelPx - 1 - stride];
      std::memcpy(here + at, from + at, kPanelPx * sizeof(float));
      std::memcpy(right + at, from + at + 1, (kPanelPx - 1) * sizeof(float));
      right[at + kPanelPx - 1] = last ? 0 : from[at + stride];
      if (last) right[at + end - 1] = 0;
    }
  }
}

}  // namespace

Convolution::Convolution(const Tensor& weights) {
  const int outputs = static_cast<int>(weights.shape[0]), inputs = static_cast<int>(weights.shape[1]);
  const size_t columns = 3 * static_cast<size_t>(inputs);
  std::vector<float> row(static_cast<size_t>(outputs) * columns);
  for (size_t y = 0; y < 3; ++y) {
    for (size_t o = 0; o < static_cast<size_t>(outputs); ++o)
      for (size_t c = 0; c < columns; ++c) {
        const size_t column = c / static_cast<size_t>(inputs), input = c % static_cast<size_t>(inputs);
        row[o * columns + c] =
            weights.values[((o * static_cast<size_t>(inputs) + input) * 3 + y) * 3 + column];
      }
    rows_[y] = PackedMatrix(row.data(), outputs, static_cast<int>(columns), columns);
  }
}

Panels Convolution::Run(const Panels& image, Workspace& workspace) const {
  Panels out(rows_[0].Rows(), image.Size(), workspace);
  const std::vector<RowTile> tiles = RowTiles(image.Size(), 9 * image.PanelStride() * sizeof(float));
  tbb::parallel_for(size_t{0}, tiles.size(), [&](size_t i) {
    workspace.WithScratch([&](Scratch& scratch) { RunTile(image, tiles[i], out, scratch); });
  });
  return out;
}

void Convolution::RunTile(const Panels& image, const RowTile& tile, Panels& out, Scratch& scratch) const {
  float* taken[3];
  for (float*& row : taken) row = scratch.Take(tile.PanelCount() * 3 * image.PanelStride());
  const auto row_at = [&](int y) { return taken[(y + 3) % 3]; };
  const int height = image.Size().height, px = static_cast<int>(tile.PanelCount()) * kPanelPx;
  for (int y = tile.first_row - 1; y <= tile.end_row; ++y) {
    if (y >= 0 && y < height) TakeColumns(image, y, tile, row_at(y));
    const int done = y - 1;
    if (done < tile.first_row) continue;
    const RowPlace to{out.At(done, static_cast<ptrdiff_t>(tile.first_panel)), out.PanelStride(), kPanelPx};
    Multiply(rows_[1], row_at(done), 0, px, to);
    if (done > 0) Multiply(rows_[0], row_at(done - 1), 0, px, to, to.data);
    if (done + 1 < height) Multiply(rows_[2], row_at(done + 1), 0, px, to, to.data);
  }
}

}  // namespace shimmer::restore
