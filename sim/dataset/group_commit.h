// Durability in groups: what is handed in is made durable by a thread of its own, all that has come in the
// meantime at once, so that nobody waits for the disk at each piece.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace shimmer::dataset {

template <class Item>
class GroupCommit {
 public:
  using Commit = std::function<void(std::vector<Item>)>;

  // most_items: handed in and not yet durable; what a kill can cost. commit is called for one group at a
  // time.
  GroupCommit(size_t most_items, Commit commit)
      : most_items_(most_items), commit_(std::move(commit)), thread_([this] { Run(); }) {}

  // Drops what no Flush has waited for.
  ~GroupCommit() {
    {
      const std::lock_guard guard(mutex_);
      ending_ = true;
      waiting_.clear();
    }
    changed_.notify_all();
  }

  // Waits while there are most_items already. Throws what commit has thrown, then and ever after: nothing is
  // taken any more.
  void Push(Item item) {
    std::unique_lock guard(mutex_);
    changed_.wait(guard, [&] { return error_ || waiting_.size() + committing_ < most_items_; });
    if (error_) std::rethrow_exception(error_);
    waiting_.push_back(std::move(item));
    changed_.notify_all();
  }

  // Waits until all that was pushed is durable.
  void Flush() {
    std::unique_lock guard(mutex_);
    flushing_ = true;
    changed_.notify_all();
    changed_.wait(guard, [&] { return error_ || (waiting_.empty() && committing_ == 0); });
    flushing_ = false;
    if (error_) std::rethrow_exception(error_);
  }

 private:
  // A group is what comes within this time, or half of what may wait.
  static constexpr std::chrono::milliseconds kGather{250};

  void Run() {
    std::unique_lock guard(mutex_);
    for (;;) {
      changed_.wait(guard, [&] { return ending_ || !waiting_.empty(); });
      changed_.wait_for(guard, kGather,
                        [&] { return ending_ || flushing_ || waiting_.size() >= most_items_ / 2; });
      if (ending_) return;
      std::vector<Item> group = std::exchange(waiting_, {});
      committing_ = group.size();
      guard.unlock();
      std::exception_ptr error;
      try {
        commit_(std::move(group));
      } catch (...) {
        error = std::current_exception();
      }
      guard.lock();
      committing_ = 0;
      if (error) {
        error_ = error;
        waiting_.clear();
      }
      changed_.notify_all();
      if (error_) return;
    }
  }

  const size_t most_items_;
  const Commit commit_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Item> waiting_;
  size_t committing_ = 0;
  bool flushing_ = false, ending_ = false;
  std::exception_ptr error_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace shimmer::dataset
