// Loops on all threads: oneTBB's. ThreadSanitizer can't see how oneTBB, which Debian builds without it, hands
// work over, and would take every loop for a race: under it the same bodies run on plain threads.
#pragma once

#ifdef __SANITIZE_THREAD__
#include <atomic>
#include <thread>
#include <vector>
#else
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#endif

namespace shimmer::sim {

#ifdef __SANITIZE_THREAD__

// Calls f(i) for begin <= i < end, in any order.
template <class F>
void ParallelFor(int begin, int end, const F& f) {
  std::atomic<int> next = begin;
  std::vector<std::jthread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&] {
      for (int mine = next++; mine < end; mine = next++) f(mine);
    });
}

template <class... F>
void ParallelInvoke(const F&... f) {
  std::vector<std::jthread> threads;
  (threads.emplace_back([&f] { f(); }), ...);
}

#else

template <class F>
void ParallelFor(int begin, int end, const F& f) {
  tbb::parallel_for(begin, end, f);
}

template <class... F>
void ParallelInvoke(const F&... f) {
  tbb::parallel_invoke(f...);
}

#endif

}  // namespace shimmer::sim
