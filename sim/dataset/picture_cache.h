// Decoded pictures, kept for the next clip that shows them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "sim/dataset/image_io.h"

namespace shimmer::dataset {

// For any number of threads. Keeps the pictures that were asked for last, as many as the budget holds beside
// those that are being read: each of these is taken for the largest so far, and as much again for its
// decoder, all together for half of the budget at most. What someone still holds that is no longer kept comes
// on top.
class PictureCache {
 public:
  explicit PictureCache(uint64_t budget_bytes) : budget_bytes_(budget_bytes) {}

  // As ReadSamples, and what that throws. A picture that several ask for at once is read once; one that is
  // larger than the budget is not kept, nor is an error. It is shared: nobody writes to its pixels.
  std::shared_ptr<const Picture> Read(const std::filesystem::path& path);

  void SetBudget(uint64_t bytes);

  struct Statistics {
    int64_t hits = 0;       // was there, or was being read
    int64_t misses = 0;     // had to be read
    int64_t evictions = 0;  // made room for others
    uint64_t held_bytes = 0;
  };
  Statistics statistics() const;

 private:
  struct Entry {
    std::shared_future<std::shared_ptr<const Picture>> picture;  // null if it can't be read
    std::list<std::string>::iterator place;  // in by_age_; its end while the picture is being read
    uint64_t bytes = 0;
  };

  void Keep(const std::string& path, uint64_t bytes);
  void MakeRoom();

  mutable std::mutex mutex_;  // of all that follows
  uint64_t budget_bytes_;
  uint64_t largest_bytes_ = 0, being_read_ = 0;
  std::unordered_map<std::string, Entry> entries_;
  std::list<std::string> by_age_;  // the one that was asked for last first
  Statistics statistics_;
};

}  // namespace shimmer::dataset
