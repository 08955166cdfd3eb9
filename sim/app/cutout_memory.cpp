#include "sim/app/cutout_memory.h"

#include <algorithm>

namespace shimmer::app {

CutoutMemory::Shared CutoutMemory::Get(const std::string& name, const std::function<Shared()>& read) {
  const auto find = [&] { return std::ranges::find(kept_, name, &std::pair<std::string, Shared>::first); };
  {
    const std::lock_guard guard(mutex_);
    if (const auto known = find(); known != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, known);
      return known->second;
    }
  }
  Shared cutout = read();  // two threads may both read one that is new: they get the same
  const std::lock_guard guard(mutex_);
  if (find() != kept_.end() || cutout->bytes() > budget_bytes_) return cutout;
  kept_.emplace_front(name, cutout);
  held_bytes_ += cutout->bytes();
  for (; held_bytes_ > budget_bytes_; kept_.pop_back()) held_bytes_ -= kept_.back().second->bytes();
  return cutout;
}

}  // namespace shimmer::app
