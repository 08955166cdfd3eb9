// Fault 13: several processes on one folder, with locks of the system and on a file system that has none.
#include <cmath>

#include "tests/app/sets.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

using Clock = std::chrono::steady_clock;

class Writers : public testing::TestWithParam<bool> {
 protected:
  // Slow enough for others to find one at work.
  void SetUp() override {
    folder_.Put("c.json",
                SetConfig("sequence", 24,
                          {{"size", {64, 48}}, {"blur", {{"max_sigma_px", 4}, {"method", "exact"}}}}));
    ExpectDone(RunForked(folder_, GenerateWords("c.json", "whole")));
    whole_ = WholeTree(folder_ / "whole");
  }
  // On a folder whose file system has locks, or says that it has none.
  Faults Locks() const {
    if (!GetParam()) return {.root = folder_ / "set"};
    return {.root = folder_ / "set", .calls = "flock", .mode = "persistent", .at = 1, .error = ENOLCK};
  }
  FaultyRun Start(const Words& more = {}) {
    return FaultyRun(folder_.path(), GenerateWords("c.json", "set", more), Locks());
  }
  Ran Run(const Words& more = {}) { return Start(more).Wait(); }
  void WaitUntilAtWork(const std::string& manifest = "manifest.jsonl") {
    WaitUntil([&] { return fs::exists(folder_ / ("set/" + manifest)); });
  }

  TempFolder folder_;
  std::map<std::string, std::string> whole_;
};
INSTANTIATE_TEST_SUITE_P(FileSystems, Writers, testing::Bool(),
                         [](const auto& info) { return info.param ? "WithoutLocks" : "WithLocks"; });

// Begun at the same moment: one at least makes its clips, and whoever does not says who does.
TEST_P(Writers, OfOneFolderExcludeEachOther) {
  const int runs = Times(3, 20);
  int told = 0;
  for (int run = 0; run < runs; ++run)
    for (const Words& more : {Words{}, Words{"--shard", "0/1"}}) {
      fs::remove_all(folder_ / "set");
      FaultyRun first = Start(more), second = Start(more);
      const Ran a = first.Wait(), b = second.Wait();
      for (const Ran& ran : {a, b})
        if (ran.exit_code != 0) ExpectOneLine(ran, 1, {"set: ", "process", " writes to this data set"});
      EXPECT_TRUE(a.exit_code == 0 || b.exit_code == 0);
      told += (a.exit_code != 0) + (b.exit_code != 0);
      EXPECT_EQ(Differing(whole_, WholeTree(folder_ / "set")), Words());
    }
  EXPECT_GT(told, 0);
  Tell(std::string("13 two writers, ") + (GetParam() ? "no locks" : "locks") + ": " +
       std::to_string(2 * runs) + " pairs, " + std::to_string(told) + " told, all sets equal");
}

// Two that were both given the same part.
TEST_P(Writers, OfOneShardExcludeEachOther) {
  const int runs = Times(2, 20);
  int told = 0;
  for (int run = 0; run < runs; ++run) {
    fs::remove_all(folder_ / "set");
    FaultyRun first = Start({"--shard", "0/2"}), second = Start({"--shard", "0/2"}),
              other = Start({"--shard", "1/2"});
    const Ran a = first.Wait(), b = second.Wait();
    ExpectDone(other.Wait());
    for (const Ran& ran : {a, b})
      if (ran.exit_code != 0) ExpectOneLine(ran, 1, {"set: ", "process", " writes to shard 000-of-002"});
    EXPECT_TRUE(a.exit_code == 0 || b.exit_code == 0);
    told += (a.exit_code != 0) + (b.exit_code != 0);
    EXPECT_EQ(FaultyRun(folder_.path(), {"merge", "set"}, Locks()).Wait().exit_code, 0);
    EXPECT_EQ(Differing(whole_, WholeTree(folder_ / "set")), Words());
  }
  EXPECT_GT(told, 0);
  Tell(std::string("13 one shard twice, ") + (GetParam() ? "no locks" : "locks") + ": " +
       std::to_string(runs) + " runs, " + std::to_string(told) + " told, all sets equal");
}

// As many as a job array starts at once.
TEST_P(Writers, OfManyShardsBeginTogether) {
  const int runs = Times(3, 20);
  for (int run = 0; run < runs; ++run) {
    fs::remove_all(folder_ / "set");
    std::vector<std::unique_ptr<FaultyRun>> shards;
    for (int shard = 0; shard < 12; ++shard)
      shards.push_back(std::make_unique<FaultyRun>(
          folder_.path(), GenerateWords("c.json", "set", {"--shard", std::to_string(shard) + "/12"}),
          Locks()));
    for (const auto& shard : shards) ExpectDone(shard->Wait());
    EXPECT_EQ(FaultyRun(folder_.path(), {"merge", "set"}, Locks()).Wait().exit_code, 0);
    EXPECT_EQ(Differing(whole_, WholeTree(folder_ / "set")), Words());
  }
  Tell(std::string("13 twelve shards at once, ") + (GetParam() ? "no locks" : "locks") + ": " +
       std::to_string(runs) + " runs, all sets equal");
}

// While another is at work for sure, one is told at once.
TEST_P(Writers, AreToldWithinASecond) {
  const int runs = Times(1, 20);
  double longest_seconds = 0;
  for (int run = 0; run < runs; ++run) {
    fs::remove_all(folder_ / "set");
    FaultyRun first = Start();
    WaitUntilAtWork();
    const auto start = Clock::now();
    const Ran second = Run();
    longest_seconds = std::max(longest_seconds, std::chrono::duration<double>(Clock::now() - start).count());
    ExpectOneLine(second, 1, {"set: process ", " writes to this data set; wait for it to end"});
    ExpectDone(first.Wait());
  }
  if (InSoak()) {
    EXPECT_LT(longest_seconds, 1);
  }
  Tell(std::string("13 told, ") + (GetParam() ? "no locks" : "locks") + ": " + std::to_string(runs) +
       " runs, after " + std::to_string(std::lround(longest_seconds * 1000)) + " ms at the most");
}

TEST_P(Writers, ThatWereKilledHoldNothing) {
  for (int run = 0; run < Times(2, 20); ++run) {
    fs::remove_all(folder_ / "set");
    FaultyRun first = Start();
    WaitUntilAtWork();
    first.Signal(SIGKILL);
    EXPECT_EQ(first.Wait().exit_code, 128 + SIGKILL);
    ExpectDone(Run());
    EXPECT_EQ(Differing(whole_, WholeTree(folder_ / "set")), Words());
  }
}

// Without locks of the system the file says who holds it: one on another host is at work while its date is
// fresh.
TEST_P(Writers, OnAnotherHostAreBelievedWhileTheyRenewTheirDate) {
  ExpectDone(Run({"--clip", "0"}));
  folder_.Put("set/.lock", R"({"host":"elsewhere","process":12345,"start":"1"})"
                           "\n");
  const Ran fresh = Run();
  if (!GetParam()) return ExpectDone(fresh);  // its lock is gone with its process
  ExpectOneLine(fresh, 1, {"set: process 12345 on elsewhere writes to this data set"});
  fs::last_write_time(folder_ / "set/.lock", fs::file_time_type::clock::now() - std::chrono::hours(1));
  ExpectDone(Run());
  EXPECT_EQ(dataset::DatasetReader(folder_ / "set").clips().size(), 24u);
}

}  // namespace
}  // namespace shimmer::app
