#include "restore/workspace.h"

#include <algorithm>

namespace shimmer::restore {

float* Scratch::Take(size_t count) {
  if (taken_ == pieces_.size()) pieces_.emplace_back();
  Piece& piece = pieces_[taken_++];
  if (piece.count < count) piece = {MakeFloats(count), count};
  return piece.floats.get();
}

// The smallest that is large enough. Where none is, one that is too small makes room for it.
Piece Workspace::TakePiece(size_t count) {
  {
    const std::lock_guard lock(mutex_);
    const auto smaller = [](const Piece& a, const Piece& b) { return a.count < b.count; };
    std::sort(pieces_.begin(), pieces_.end(), smaller);
    const auto fits =
        std::find_if(pieces_.begin(), pieces_.end(), [&](const Piece& p) { return p.count >= count; });
    if (fits != pieces_.end()) {
      Piece piece = std::move(*fits);
      pieces_.erase(fits);
      return piece;
    }
    if (!pieces_.empty()) pieces_.pop_back();
  }
  return {MakeFloats(count), count};
}

void Workspace::GiveBack(Piece piece) {
  const std::lock_guard lock(mutex_);
  pieces_.push_back(std::move(piece));
}

std::unique_ptr<Scratch> Workspace::TakeScratch() {
  const std::lock_guard lock(mutex_);
  if (scratches_.empty()) return std::make_unique<Scratch>();
  std::unique_ptr<Scratch> scratch = std::move(scratches_.back());
  scratches_.pop_back();
  scratch->Reset();
  return scratch;
}

void Workspace::GiveBack(std::unique_ptr<Scratch> scratch) {
  const std::lock_guard lock(mutex_);
  scratches_.push_back(std::move(scratch));
}

}  // namespace shimmer::restore
