#include "noise/key_grids.h"

#include <algorithm>

namespace shimmer::noise {

std::shared_ptr<const Grid> KeyGrids::At(int64_t key, const std::function<Grid()>& evaluate) {
  std::shared_ptr<Slot> slot;
  {
    const std::lock_guard lock(mutex_);
    const auto kept = std::ranges::find_if(slots_, [&](const auto& s) { return s->key == key; });
    if (kept != slots_.end()) {
      slots_.splice(slots_.begin(), slots_, kept);
    } else {
      slots_.push_front(std::make_shared<Slot>());
      slots_.front()->key = key;
      if (slots_.size() > kKept) slots_.pop_back();
    }
    slot = slots_.front();
  }
  std::call_once(slot->evaluated, [&] { slot->grid = std::make_unique<Grid>(evaluate()); });
  return {slot, slot->grid.get()};
}

}  // namespace shimmer::noise
