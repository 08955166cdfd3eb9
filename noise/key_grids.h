// Grids at key frames, kept for the frames between them: the few that were asked for last.
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>

#include "noise/spline_grid.h"

namespace shimmer::noise {

class KeyGrids {
 public:
  // The grid at a key frame: a kept one, or evaluate(). Threads that ask for the same one wait for one of
  // them.
  std::shared_ptr<const Grid> At(int64_t key, const std::function<Grid()>& evaluate);

 private:
  static constexpr size_t kKept = 8;  // what two frames far from each other are mixed from
  struct Slot {
    int64_t key;
    std::once_flag evaluated;
    std::unique_ptr<Grid> grid;
  };
  std::mutex mutex_;
  std::list<std::shared_ptr<Slot>> slots_;  // the one asked for last is first
};

}  // namespace shimmer::noise
