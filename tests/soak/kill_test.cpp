// Fault 1: killed at any moment and run again, it is the set of the run that nobody killed.
#include <random>

#include "tests/app/sets.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

constexpr int kClips = 200;
// With 2 threads: what waits to be named in the manifest, and what is in the making (clip_pipeline.cpp).
constexpr size_t kBatch = 64, kInHand = 5;

// Clips that a killed run had begun and not named in the manifest: each has a folder in .staging.
size_t UnfinishedClips(const fs::path& set) {
  if (!fs::exists(set / ".staging")) return 0;
  size_t clips = 0;
  for (const auto& entry : fs::directory_iterator(set / ".staging")) clips += entry.is_directory();
  return clips;
}

class Killed : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Layouts, Killed, testing::ValuesIn(kLayouts),
                         [](const auto& info) { return info.param; });

// Half of the moments are by the clock; half are before a system call that writes, so that no two of them are
// the same however fast the machine is.
TEST_P(Killed, AtAnyMomentItGoesOnToTheSameSet) {
  const TempFolder folder;
  const int clips = Times(40, kClips), kills = Times(6, 50);
  // In full: tars of 74 clips, more than a batch.
  folder.Put("c.json", SetConfig(GetParam(), clips, {{"output", {{"tar_mb", Times(1, 6)}}}}));
  const auto start = std::chrono::steady_clock::now();
  FaultyRun uninterrupted(folder.path(), GenerateWords("c.json", "whole"), {.root = folder / "whole"});
  ExpectDone(uninterrupted.Wait());
  const auto whole_us =
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start).count();
  const auto whole = WholeTree(folder / "whole");

  std::mt19937 generator(1);
  const fs::path set = folder / "set";
  int killed = 0;
  size_t most_redone = 0;
  for (int kill = 0; kill < kills; ++kill) {
    fs::remove_all(set);
    const bool by_clock = kill % 2 == 1;
    const auto call = std::uniform_int_distribution<int64_t>(1, uninterrupted.calls())(generator);
    FaultyRun run(folder.path(), GenerateWords("c.json", "set"),
                  {.root = set, .mode = "kill", .at = by_clock ? 0 : call});
    if (by_clock) {
      usleep(static_cast<useconds_t>(std::uniform_int_distribution<int64_t>(0, whole_us)(generator)));
      run.Signal(SIGKILL);
    }
    const Ran ran = run.Wait();
    ASSERT_TRUE(ran.exit_code == 128 + SIGKILL || (by_clock && ran.exit_code == 0))
        << ran.exit_code << ran.err;
    killed += ran.exit_code != 0;

    fs::create_directories(set);
    EXPECT_EQ(BrokenFiles(set), Words());
    const auto before = InodesOfDone(set);
    most_redone = std::max(most_redone, UnfinishedClips(set));
    ExpectDone(RunForked(folder, GenerateWords("c.json", "set")));
    EXPECT_EQ(Differing(whole, WholeTree(set)), Words()) << "kill " << kill << " call " << call;
    const auto after = InodesOfDone(set);
    for (const auto& [path, inode] : before) EXPECT_EQ(after.at(path), inode) << path << " was written again";
  }
  EXPECT_GE(killed, kills / 2);
  const auto clips_per_tar = dataset::DatasetReader(set).description().value("clips_per_tar", size_t{1});
  EXPECT_LE(most_redone, kBatch + kInHand + clips_per_tar - 1);
  Tell("1 kill, " + GetParam() + ": " + std::to_string(killed) + " kills over " + std::to_string(clips) +
       " clips, all sets equal; most redone " + std::to_string(most_redone) + " clips");
}

}  // namespace
}  // namespace shimmer::app
