// generate --dry-run says what a run takes, and touches nothing.
#include <sys/mount.h>

#include "tests/app/program.h"

namespace shimmer::app {
namespace {

// The text after the name of a line.
std::string ValueOf(const Ran& ran, const std::string& name) {
  std::istringstream lines(ran.out);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(name + " ")) return line.substr(line.find_first_not_of(' ', name.size()));
  return "";
}

Ran DryRun(const TempFolder& folder, const Words& more = {}) {
  Words words = {"generate", "c.json", "--out", "set", "--dry-run"};
  words.insert(words.end(), more.begin(), more.end());
  return Shimmer(folder, words);
}

TEST(DryRun, SaysWhatTheRunThenDoes) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"clips", 12}, {"frames", 3}, {"output", {{"truth", {"tilt"}}}}}));
  const Ran ran = DryRun(folder);
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ValueOf(ran, "clips"), "12 of 12");
  EXPECT_EQ(ValueOf(ran, "frames"), "36");
  EXPECT_EQ(ValueOf(ran, "files"), "84");  // 3 turbulent, 3 of truth, 1 clean
  EXPECT_THAT(ValueOf(ran, "bytes"), testing::MatchesRegex(".* a clip, from [0-9]+ clips\\)"));
  EXPECT_THAT(ValueOf(ran, "time"), testing::HasSubstr("clips/s on "));
  EXPECT_NE(ValueOf(ran, "free"), "");
  EXPECT_EQ(NamesIn(folder.path()), std::set<std::string>{"c.json"});

  ExpectDone(Generate(folder, "c.json", "set", {"--set", "clips=5"}));
  const auto before = Tree(folder / "set");
  EXPECT_EQ(ValueOf(DryRun(folder), "clips"), "7 of 12");
  EXPECT_EQ(ValueOf(DryRun(folder, {"--shard", "1/2"}), "clips"), "4 of 12");  // 5, 7, 9 and 11
  EXPECT_EQ(Tree(folder / "set"), before);
  ExpectOneLine(DryRun(folder, {"--set", "seed=9"}), 2, {"/seed is 0 there and 9 here"});
}

TEST(DryRun, EstimatesBytesOfTars) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"clips", 12}, {"output", {{"layout", "webdataset"}, {"tar_mb", 1}}}}));
  const Ran ran = DryRun(folder);
  ExpectDone(Generate(folder, "c.json", "made"));
  size_t tars = 0;
  for (const std::string& name : NamesIn(folder / "made/shards")) tars += name.ends_with(".tar");
  EXPECT_EQ(ValueOf(ran, "files"), std::to_string(tars));
}

TEST(DryRun, WarnsOfFlatFolders) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"size", {2, 2}}, {"frames", 1}}));
  for (const char* layout : {"pairs", "restormer"}) {
    const Words flat = {"--set", std::string("output.layout=") + layout};
    EXPECT_EQ(ValueOf(DryRun(folder, {flat[0], flat[1], "--set", "clips=90000"}), "warning"), "");
    EXPECT_THAT(ValueOf(DryRun(folder, {flat[0], flat[1], "--set", "clips=100001"}), "warning"),
                testing::HasSubstr("200,002 files in a few flat folders"));
  }
  EXPECT_EQ(ValueOf(DryRun(folder, {"--set", "clips=100001"}), "warning"), "");
}

TEST(DryRun, RefusesATargetThatCantHoldIt) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"size", {64, 64}}}));
  const fs::path disk = folder / "disk";
  fs::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=8m,nr_inodes=200") != 0)
    GTEST_SKIP() << "no right to mount a small file system";
  const auto dry_run = [&](const std::string& clips) {
    return Shimmer(folder,
                   {"generate", "c.json", "--out", "disk/set", "--dry-run", "--set", "clips=" + clips});
  };
  EXPECT_EQ(dry_run("5").exit_code, 0);
  for (const auto& [clips, why] : {std::pair{"1000", "would take "}, {"80", "files, but "}}) {
    const Ran ran = dry_run(clips);
    EXPECT_EQ(ran.exit_code, 1);
    EXPECT_THAT(ran.err, testing::AllOf(testing::StartsWith("shimmer: disk/set: would take "),
                                        testing::HasSubstr(why)));
  }
  EXPECT_TRUE(fs::is_empty(disk));
  umount(disk.c_str());
}

}  // namespace
}  // namespace shimmer::app
