// Fault 3: a disk that is full at any place of a run, of bytes or of files.
#include <cmath>

#include "tests/app/sets.h"
#include "tests/app/small_disk.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

struct Kind {
  std::string layout, format;
};

std::vector<Kind> Kinds() {
  std::vector<Kind> kinds;
  for (const std::string& layout : kLayouts)
    for (const char* format : {"png", "exr"}) kinds.push_back({layout, format});
  return kinds;
}

class FullDisk : public testing::TestWithParam<Kind> {
 protected:
  // Clips of noise, which does not compress: 300 kB each, more than the largest disk together.
  void SetUp() override {
    WritePng(folder_, "in.png", dataset::RandomImage({128, 128}, 3, 1), 16);
    folder_.Put(
        "c.json",
        SetConfig(GetParam().layout, Times(6, 40),
                  {{"size", {128, 128}},
                   {"source", {{"images", "in.png"}}},
                   {"output", {{"format", GetParam().format}, {"bits", 16}, {"truth", Json::array()}}}}));
    ExpectDone(RunForked(folder_, GenerateWords("c.json", "whole")));
    whole_ = WholeTree(folder_ / "whole");
  }

  // False where small disks are not permitted.
  bool Fill(const std::string& limits) {
    SmallDisk disk(folder_ / "disk", limits);
    if (!disk.mounted()) return false;
    const fs::path set = folder_ / "disk/set";
    ExpectOneLine(RunForked(folder_, GenerateWords("c.json", "disk/set")), 1,
                  {"disk/set", "No space left on device"});
    EXPECT_FALSE(fs::exists(set / ".staging")) << limits;
    if (fs::exists(set)) {
      EXPECT_EQ(BrokenFiles(set), Words()) << limits;
      clips_ += DoneClips(set).size();
      for (const auto& [path, hash] : WholeTree(set))
        EXPECT_TRUE(path == "manifest.jsonl" || whole_.at(path) == hash) << limits << ": " << path;
    }
    disk.Enlarge("size=100m,nr_inodes=100000");
    ExpectDone(RunForked(folder_, GenerateWords("c.json", "disk/set")));
    EXPECT_EQ(Differing(whole_, WholeTree(set)), Words()) << limits;
    return true;
  }

  TempFolder folder_;
  std::map<std::string, std::string> whole_;
  size_t clips_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Kinds, FullDisk, testing::ValuesIn(Kinds()),
                         [](const auto& info) { return info.param.layout + "_" + info.param.format; });

TEST_P(FullDisk, LeavesWhatIsWholeAndGoesOnWithMoreRoom) {
  const int steps = Times(2, 20);
  const double smallest = 64, largest = Times(1024, 8192);
  for (int step = 0; step < steps; ++step) {
    const double kib = smallest * std::pow(largest / smallest, static_cast<double>(step) / (steps - 1));
    if (!Fill("size=" + std::to_string(std::lround(kib)) + "k"))
      GTEST_SKIP() << "no right to mount a file system";
  }
  // A folder and each file or folder in it takes one; webdataset writes few that stay, but clips pass by.
  const int inode_steps = Times(1, 8);
  for (int step = 0; step < inode_steps; ++step) Fill("size=100m,nr_inodes=" + std::to_string(3 + 3 * step));
  Tell("3 full disk, " + GetParam().layout + " " + GetParam().format + ": " + std::to_string(steps) +
       " sizes, " + std::to_string(inode_steps) + " numbers of files; " + std::to_string(clips_) +
       " clips were finished and whole, all sets equal with more room");
}

}  // namespace
}  // namespace shimmer::app
