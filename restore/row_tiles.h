// How an image is parted for tasks that sweep down a few rows at a time.
#pragma once

#include <algorithm>
#include <vector>

#include "restore/panels.h"

namespace shimmer::restore {

struct RowTile {
  int first_row = 0, end_row = 0;
  size_t first_panel = 0, end_panel = 0;

  size_t PanelCount() const { return end_panel - first_panel; }
};

// Tiles of an image, left to right and top to bottom, alike on any number of threads: each has a px of halo,
// which is computed again, so that tiles are tall, and as wide as a sweep that keeps panel_bytes a panel has
// room for in the cache.
inline std::vector<RowTile> RowTiles(cv::Size size, size_t panel_bytes) {
  constexpr size_t kCacheBytes = 500'000, kLeastPanels = 8;
  constexpr int kLeastRows = 8, kMostRows = 64, kStrips = 8;
  const size_t panels = PanelsFor(size.width), fit = std::max(kLeastPanels, kCacheBytes / panel_bytes);
  const size_t columns = (panels + fit - 1) / fit;
  const int rows = std::clamp(size.height / kStrips, kLeastRows, kMostRows);
  const int strips = (size.height + rows - 1) / rows;
  std::vector<RowTile> tiles;
  for (int strip = 0; strip < strips; ++strip)
    for (size_t column = 0; column < columns; ++column)
      tiles.push_back({size.height * strip / strips, size.height * (strip + 1) / strips,
                       panels * column / columns, panels * (column + 1) / columns});
  return tiles;
}

}  // namespace shimmer::restore
