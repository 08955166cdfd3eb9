// Cut-outs that were read from files, kept for the clips that show them again.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "sim/cutout.h"

namespace shimmer::app {

// For any number of threads. Keeps those that were asked for last, as many as the budget holds; what someone
// still holds comes on top.
class CutoutMemory {
 public:
  using Shared = std::shared_ptr<const sim::Cutout>;

  explicit CutoutMemory(int64_t budget_bytes) : budget_bytes_(budget_bytes) {}

  // That of the name; what `read` gives where it isn't kept, and what that throws.
  Shared Get(const std::string& name, const std::function<Shared()>& read);

 private:
  std::mutex mutex_;  // of what follows
  int64_t budget_bytes_, held_bytes_ = 0;
  std::list<std::pair<std::string, Shared>> kept_;  // the one that was asked for last first
};

}  // namespace shimmer::app
