// Memory that is used again and again: pages that a program touches for the first time cost more than much of
// what is computed in them.
#pragma once

#include <hwy/aligned_allocator.h>

#include <memory>
#include <mutex>
#include <vector>

namespace shimmer::restore {

// Floats whose values are not set, aligned for every SIMD target.
using Floats = hwy::AlignedFreeUniquePtr<float[]>;
inline Floats MakeFloats(size_t count) { return hwy::AllocateAligned<float>(count); }

struct Piece {
  Floats floats;
  size_t count = 0;
};

// Of one task at a time. What is taken is the task's until Reset.
class Scratch {
 public:
  void Reset() { taken_ = 0; }
  float* Take(size_t count);

 private:
  std::vector<Piece> pieces_;
  size_t taken_ = 0;
};

// May be used from several threads at once. It keeps as many pieces as were in use at once, of the sizes that
// were asked for last.
class Workspace {
 public:
  Piece TakePiece(size_t count);  // of count or more
  void GiveBack(Piece piece);

  // task(Scratch&)
  template <class Task>
  void WithScratch(const Task& task) {
    std::unique_ptr<Scratch> scratch = TakeScratch();
    task(*scratch);
    GiveBack(std::move(scratch));
  }

 private:
  std::unique_ptr<Scratch> TakeScratch();
  void GiveBack(std::unique_ptr<Scratch> scratch);

  std::mutex mutex_;
  std::vector<Piece> pieces_;  // that are idle, as scratches_ are
  std::vector<std::unique_ptr<Scratch>> scratches_;
};

}  // namespace shimmer::restore
