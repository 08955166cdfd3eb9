// How many threads a command may take.
#pragma once

#include <tbb/global_control.h>

#include <algorithm>
#include <thread>

namespace shimmer::restore::app {

// threads > 0, or all that there are.
inline int ThreadCount(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

// No more than these, while it lives.
class Threads {
 public:
  explicit Threads(int threads)
      : control_(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(ThreadCount(threads))) {}

 private:
  tbb::global_control control_;
};

}  // namespace shimmer::restore::app
