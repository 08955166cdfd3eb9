#include "sim/dataset/folder_lock.h"

#include <sys/wait.h>
#include <unistd.h>

#include "tests/dataset/temp_folder.h"

namespace shimmer::dataset {
namespace {

std::string WhyBusy(const TempFolder& folder, const Shard& shard) {
  return ErrorOf<FolderBusy>([&] { FolderLock lock(folder.path(), shard); });
}

TEST(FolderLock, OneForTheWholeSet) {
  const TempFolder folder;
  {
    const FolderLock lock(folder.path(), {});
    const std::string why = WhyBusy(folder, {});
    EXPECT_TRUE(Contains(why, "process " + std::to_string(getpid()) + " on ")) << why;
    EXPECT_TRUE(Contains(why, "writes to this data set")) << why;
    EXPECT_NE(WhyBusy(folder, {0, 2}), "");
  }
  EXPECT_EQ(WhyBusy(folder, {}), "");
  EXPECT_EQ(std::filesystem::file_size(folder / ".lock"), 0u);
}

TEST(FolderLock, ShardsOfOneCountTogether) {
  const TempFolder folder;
  const FolderLock first(folder.path(), {0, 3});
  const FolderLock second(folder.path(), {1, 3});
  EXPECT_TRUE(Contains(WhyBusy(folder, {1, 3}), "writes to shard 001-of-003"));
  EXPECT_NE(WhyBusy(folder, {}), "");
  EXPECT_NE(WhyBusy(folder, {3, 8}), "");  // its clips are others' too
  EXPECT_EQ(WhyBusy(folder, {2, 3}), "");
  EXPECT_EQ(WhyBusy(folder, {2, 3}), "");
}

// Whoever was refused holds nothing.
TEST(FolderLock, ARefusalLeavesNoLock) {
  const TempFolder folder;
  {
    const FolderLock shard(folder.path(), {0, 2});
    EXPECT_NE(WhyBusy(folder, {}), "");
    EXPECT_EQ(WhyBusy(folder, {1, 2}), "");
  }
  EXPECT_EQ(WhyBusy(folder, {}), "");
}

TEST(FolderLock, OfADeadProcessIsNobodys) {
  const TempFolder folder;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const FolderLock lock(folder.path(), {});
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  EXPECT_GT(std::filesystem::file_size(folder / ".lock"), 0u);  // it still names the dead one
  EXPECT_EQ(WhyBusy(folder, {}), "");
}

}  // namespace
}  // namespace shimmer::dataset
