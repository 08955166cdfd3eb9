// Memory of grids that are no longer needed, for those of the next frame: fresh memory costs as much time as
// what is written to it. As many are kept as were ever in use at once.
#pragma once

#include <algorithm>
#include <mutex>
#include <vector>

#include "noise/spline_grid.h"

namespace shimmer::noise {

class SpareGrids {
 public:
  Grid Take(const PixelArea& area) {  // its values are whatever was there
    std::vector<float> values;
    {
      const std::lock_guard lock(mutex_);
      const auto fits = [&](const std::vector<float>& v) { return v.size() == area.Points(); };
      const auto spare = std::ranges::find_if(spare_, fits);
      if (spare != spare_.end()) {
        values = std::move(*spare);
        spare_.erase(spare);
      }
    }
    values.resize(area.Points());
    return {area, std::move(values)};
  }

  void Give(Grid grid) {
    const std::lock_guard lock(mutex_);
    spare_.push_back(std::move(grid.values));
  }

 private:
  std::mutex mutex_;
  std::vector<std::vector<float>> spare_;
};

}  // namespace shimmer::noise
