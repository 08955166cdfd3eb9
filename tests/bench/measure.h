// How long something takes and how much memory it needs.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace shimmer::bench {

double Median(std::vector<double> values);  // values must not be empty

struct Timing {             // of one run
  double wall_ms = 0;       // median of the blocks' means
  double cpu_ms = 0;        // the same, of all threads together
  double best_wall_ms = 0;  // of the quickest block: what other jobs on the machine disturb least
  int runs = 0;
};

// How long and how often to measure. Runs are timed in blocks, so that what is done once in a few frames
// counts its share; blocks are shorter where least_blocks of them would take longer than seconds.
struct Patience {
  double seconds = 1;  // no new block after this
  int least_blocks = 3, most_blocks = 50;
  int block_runs = 8;
};

// Calls run(i) with i = 0 once to warm up, then with i = 1, 2, ... and the clock on.
Timing Measure(const Patience& patience, const std::function<void(int)>& run);

// Memory that the process holds beyond what it held when this was made. Linux; throws std::runtime_error
// where /proc does not tell.
class PeakMemory {
 public:
  PeakMemory();
  int64_t Bytes() const;  // the peak since then

 private:
  int64_t before_bytes_;
};

}  // namespace shimmer::bench
