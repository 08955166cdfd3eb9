// Shards that begin at the same moment, as the tasks of a job array do: none may stand in another's way.
#include <gmock/gmock.h>

#include <barrier>
#include <mutex>
#include <thread>

#include "sim/dataset/dataset_reader.h"
#include "sim/dataset/unite.h"
#include "tests/dataset/small_set.h"

namespace shimmer::dataset {
namespace {

constexpr int kShards = 8;

// Each makes the clip of its own number, if it is not there. What they throw.
std::vector<std::string> RunAtOnce(const std::filesystem::path& folder) {
  std::vector<std::string> errors;
  std::mutex guard;
  std::barrier start(kShards);
  std::vector<std::jthread> shards;
  for (int shard = 0; shard < kShards; ++shard)
    shards.emplace_back([&, shard] {
      start.arrive_and_wait();
      const std::string error = ErrorOf<std::exception>([&] {
        DatasetWriter writer(folder, Sequence(), Description(), {.index = shard, .count = kShards});
        if (!writer.done().contains(shard)) CommitNow(writer, shard, SmallClip(Sequence(), shard));
      });
      const std::lock_guard lock(guard);
      if (!error.empty()) errors.push_back(error);
    });
  shards.clear();
  return errors;
}

TEST(ShardsAtOnce, AllBeginInANewFolder) {
  for (int round = 0; round < 30; ++round) {
    const TempFolder folder;
    EXPECT_THAT(RunAtOnce(folder / "set"), testing::IsEmpty()) << "round " << round;
    EXPECT_EQ(DatasetReader(folder / "set").clips().size(), kShards) << "round " << round;
  }
}

TEST(ShardsAtOnce, AllGoOnInAFolderThatWasMerged) {
  const TempFolder folder;
  ASSERT_THAT(RunAtOnce(folder / "set"), testing::IsEmpty());
  for (int round = 0; round < 30; ++round) {
    UniteManifests(folder / "set", FolderLock(folder / "set", {}));
    EXPECT_THAT(RunAtOnce(folder / "set"), testing::IsEmpty()) << "round " << round;
  }
}

// What a run of another number of shards has left stands in nobody's way, and is gone when all is one set.
TEST(ShardsAtOnce, WorkBesideWhatOtherNumbersOfShardsHaveLeft) {
  const TempFolder folder;
  for (int clip = 0; clip < kShards + 2; ++clip) {
    const std::string staging = "set/.staging.00" + std::to_string(clip % 3) + "-of-003/",
                      number = std::to_string(clip);
    folder.Put(staging + number + "/clips/00000" + number + "/clean/0000.png", std::string("half a clip"));
    folder.Put("set/clips/00000" + number + "/turb/0007.png", std::string("moved and not named"));
  }
  folder.Put("set/dataset.json", Description().dump());
  EXPECT_THAT(RunAtOnce(folder / "set"), testing::IsEmpty());
  { const DatasetWriter whole(folder / "set", Sequence(), Description()); }
  UniteManifests(folder / "set", FolderLock(folder / "set", {}));
  for (const auto& entry : std::filesystem::directory_iterator(folder / "set"))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".staging")) << entry.path();
  size_t files = 2;  // dataset.json and manifest.jsonl
  for (int clip = 0; clip < kShards; ++clip) files += SmallClip(Sequence(), clip).size();
  EXPECT_EQ(Tree(folder / "set").size(), files);
}

}  // namespace
}  // namespace shimmer::dataset
