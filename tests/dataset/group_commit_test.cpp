#include "sim/dataset/group_commit.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <numeric>
#include <stdexcept>

namespace shimmer::dataset {
namespace {

TEST(GroupCommit, EveryItemIsCommittedOnceInItsOrder) {
  std::vector<int> committed;
  GroupCommit<int> commits(8, [&](std::vector<int> group) {
    EXPECT_LE(group.size(), 8u);
    committed.insert(committed.end(), group.begin(), group.end());
  });
  for (int i = 0; i < 100; ++i) commits.Push(i);
  commits.Flush();
  std::vector<int> all(100);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(committed, all);
  commits.Flush();  // of nothing
}

// While one group is made durable, no more comes in than a kill may cost.
TEST(GroupCommit, NoMoreWaitThanAKillMayCost) {
  std::promise<void> released;
  std::atomic<int> pushed{0};
  GroupCommit<int> commits(
      4, [&, release = released.get_future().share()](std::vector<int>) { release.wait(); });
  std::jthread pusher([&] {
    for (int i = 0; i < 10; ++i) {
      commits.Push(i);
      ++pushed;
    }
  });
  while (pushed < 4) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // time to do wrong
  EXPECT_EQ(pushed, 4);
  released.set_value();
  pusher.join();
  commits.Flush();
  EXPECT_EQ(pushed, 10);
}

TEST(GroupCommit, AnErrorIsThrownThenAndEverAfter) {
  GroupCommit<int> commits(4, [](const std::vector<int>&) { throw std::runtime_error("full"); });
  commits.Push(1);
  EXPECT_THROW(commits.Flush(), std::runtime_error);
  EXPECT_THROW(commits.Push(2), std::runtime_error);
  EXPECT_THROW(commits.Flush(), std::runtime_error);
}

TEST(GroupCommit, WhatNobodyWaitedForMayBeDropped) {
  std::atomic<int> committed{0};
  {
    GroupCommit<int> commits(
        1000, [&](const std::vector<int>& group) { committed += static_cast<int>(group.size()); });
    commits.Push(1);
    commits.Flush();
    commits.Push(2);
  }
  EXPECT_GE(committed, 1);
}

}  // namespace
}  // namespace shimmer::dataset
