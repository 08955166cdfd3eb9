#include "tests/bench/measure.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <string>

namespace shimmer::bench {
namespace {

double CpuSeconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double WallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

int64_t StatusBytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(name + ":")) return std::stoll(line.substr(name.size() + 1)) * 1024;
  throw std::runtime_error("/proc/self/status has no " + name);
}

}  // namespace

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Timing Measure(const Patience& patience, const std::function<void(int)>& run) {
  const double start = WallSeconds();
  run(0);
  const double once = WallSeconds() - start;
  const int block_runs =
      std::max(1, static_cast<int>(std::min<double>(patience.block_runs,
                                                    patience.seconds / (patience.least_blocks * once))));
  std::vector<double> wall_ms, cpu_ms;
  Timing timing;
  for (int block = 0; block < patience.most_blocks; ++block) {
    if (block >= patience.least_blocks && WallSeconds() - start > patience.seconds) break;
    const double wall = WallSeconds(), cpu = CpuSeconds();
    for (int i = 0; i < block_runs; ++i) run(++timing.runs);
    cpu_ms.push_back(1e3 * (CpuSeconds() - cpu) / block_runs);
    wall_ms.push_back(1e3 * (WallSeconds() - wall) / block_runs);
  }
  timing.wall_ms = Median(wall_ms);
  timing.cpu_ms = Median(cpu_ms);
  timing.best_wall_ms = *std::ranges::min_element(wall_ms);
  return timing;
}

PeakMemory::PeakMemory() {
  malloc_trim(0);                                 // what was freed before must not serve again, uncounted
  std::ofstream("/proc/self/clear_refs") << "5";  // the peak starts anew (proc(5))
  before_bytes_ = StatusBytes("VmRSS");
}

int64_t PeakMemory::Bytes() const { return std::max<int64_t>(0, StatusBytes("VmHWM") - before_bytes_); }

}  // namespace shimmer::bench
