#include "sim/dataset/picture_cache.h"

#include <algorithm>

namespace shimmer::dataset {
namespace {

// With what an entry takes beside its pixels: it counts where there are very many small pictures.
uint64_t BytesOf(const Picture& picture) {
  constexpr uint64_t kEntryBytes = 1024;
  return picture.pixels.total() * picture.pixels.elemSize() + kEntryBytes;
}

}  // namespace

std::shared_ptr<const Picture> PictureCache::Read(const std::filesystem::path& path) {
  const std::string& key = path.native();
  std::promise<std::shared_ptr<const Picture>> promise;
  {
    std::unique_lock lock(mutex_);
    if (const auto known = entries_.find(key); known != entries_.end()) {
      ++statistics_.hits;
      const Entry& entry = known->second;
      if (entry.place != by_age_.end()) by_age_.splice(by_age_.begin(), by_age_, entry.place);
      const auto read = entry.picture;
      lock.unlock();
      if (auto picture = read.get()) return picture;
      return std::make_shared<const Picture>(ReadSamples(path));  // throws what is wrong with it, most likely
    }
    ++statistics_.misses;
    entries_.emplace(key, Entry{promise.get_future().share(), by_age_.end()});
    ++being_read_;
    MakeRoom();
  }
  std::shared_ptr<const Picture> picture;
  try {
    picture = std::make_shared<const Picture>(ReadSamples(path));
  } catch (...) {
    {
      const std::lock_guard lock(mutex_);
      entries_.erase(key);
      --being_read_;
    }
    promise.set_value(nullptr);
    throw;
  }
  promise.set_value(picture);
  const std::lock_guard lock(mutex_);
  --being_read_;
  Keep(key, BytesOf(*picture));
  return picture;
}

void PictureCache::SetBudget(uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  budget_bytes_ = bytes;
  MakeRoom();
}

PictureCache::Statistics PictureCache::statistics() const {
  const std::lock_guard lock(mutex_);
  return statistics_;
}

void PictureCache::Keep(const std::string& path, uint64_t bytes) {
  const auto entry = entries_.find(path);
  largest_bytes_ = std::max(largest_bytes_, bytes);
  if (bytes > budget_bytes_) {
    entries_.erase(entry);
    return;
  }
  by_age_.push_front(path);
  entry->second.place = by_age_.begin();
  entry->second.bytes = bytes;
  statistics_.held_bytes += bytes;
  MakeRoom();
}

void PictureCache::MakeRoom() {
  const uint64_t read_bytes = std::min(being_read_ * 2 * largest_bytes_, budget_bytes_ / 2);
  while (!by_age_.empty() && statistics_.held_bytes + read_bytes > budget_bytes_) {
    const auto oldest = entries_.find(by_age_.back());
    statistics_.held_bytes -= oldest->second.bytes;
    ++statistics_.evictions;
    entries_.erase(oldest);
    by_age_.pop_back();
  }
}

}  // namespace shimmer::dataset
