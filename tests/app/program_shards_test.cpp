// Shards, in one folder or in several: merged, they are the set of one process, file by file.
#include "tests/app/program.h"

namespace shimmer::app {
namespace {

std::string ConfigOf(const std::string& layout) {
  return SmallConfig(
      {{"clips", 7},
       {"output", {{"layout", layout}, {"any_length", true}, {"test_fraction", 0.3}, {"truth", {"tilt"}}}}});
}

class ShardsOfLayout : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Program, ShardsOfLayout,
                         testing::Values("sequence", "pairs", "restormer", "basicsr", "webdataset"),
                         [](const auto& info) { return info.param; });

TEST_P(ShardsOfLayout, MergedAreTheWholeSet) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf(GetParam()));
  ExpectDone(Generate(folder, "c.json", "whole"));
  for (const char* shard : {"2", "0", "1"}) {
    ExpectDone(Generate(folder, "c.json", "one", {"--shard", std::string(shard) + "/3"}));
    ExpectDone(Generate(folder, "c.json", std::string("of") + shard, {"--shard", std::string(shard) + "/3"}));
  }
  // A set at any time: shards count before they are merged.
  EXPECT_EQ(dataset::DatasetReader(folder / "one").clips().size(), 7u);
  for (const Words& words : {Words{"merge", "one"}, Words{"merge", "several", "of0", "of1", "of2"}}) {
    const Ran merged = Shimmer(folder, words);
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_THAT(merged.out, testing::HasSubstr(words[1] + ": 7 of 7 clips done, 0 failed"));
    EXPECT_EQ(Tree(folder / words[1]), Tree(folder / "whole"));
    EXPECT_EQ(NamesIn(folder / words[1]), NamesIn(folder / "whole"));
  }
  // What was merged is as it was, and may be merged again.
  EXPECT_EQ(dataset::DatasetReader(folder / "of1").clips().size(), GetParam() == "webdataset" ? 0u : 2u);
  EXPECT_EQ(Shimmer(folder, {"merge", "several", "of0", "of2"}).exit_code, 0);
  EXPECT_EQ(Tree(folder / "several"), Tree(folder / "whole"));
}

TEST(Shards, MissingOnesAreNamed) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf("sequence"));
  ExpectDone(Generate(folder, "c.json", "set", {"--shard", "0/3"}));
  ExpectDone(Generate(folder, "c.json", "set", {"--shard", "2/3", "--clip", "2"}));
  const Ran merged = Shimmer(folder, {"merge", "set"});
  EXPECT_EQ(merged.exit_code, 1);
  EXPECT_EQ(merged.out,
            "set: 4 of 7 clips done, 0 failed\nshard 1/3: 2 clips missing\nshard 2/3: 1 clip missing\n");
  // The same commands again complete it, with any number of shards or none.
  ExpectDone(Generate(folder, "c.json", "set", {"--shard", "1/2"}));
  ExpectDone(Generate(folder, "c.json", "set"));
  EXPECT_EQ(Shimmer(folder, {"merge", "set"}).exit_code, 0);
  ExpectDone(Generate(folder, "c.json", "whole"));
  EXPECT_EQ(Tree(folder / "set"), Tree(folder / "whole"));
}

TEST(Shards, OfOtherSetsAreRefused) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf("sequence"));
  ExpectDone(Generate(folder, "c.json", "a", {"--shard", "0/2"}));
  ExpectDone(Generate(folder, "c.json", "b", {"--shard", "1/2", "--set", "seed=5"}));
  ExpectOneLine(Shimmer(folder, {"merge", "a", "b"}), 2, {"b: is made from something else than a", "/seed"});
  EXPECT_EQ(dataset::DatasetReader(folder / "a").clips().size(), 4u);
  ExpectOneLine(Shimmer(folder, {"merge", "nothing"}), 1, {"nothing: not a data set"});
  // Nothing is begun before all have been looked at.
  ExpectOneLine(Shimmer(folder, {"merge", "new", "a", "b"}), 2, {"b: is made from something else than a"});
  EXPECT_FALSE(fs::exists(folder / "new"));
  folder.Put("photos/1.png", "x");
  ExpectOneLine(Shimmer(folder, {"merge", "a", "photos"}), 1, {"photos: not a data set"});
  EXPECT_EQ(NamesIn(folder / "photos"), std::set<std::string>{"1.png"});
}

TEST(Shards, OfTwoCountsAreOneSetToo) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf("sequence"));
  ExpectDone(Generate(folder, "c.json", "set", {"--shard", "0/4"}));
  ExpectDone(Generate(folder, "c.json", "set", {"--shard", "1/3"}));
  folder.Put("set/manifest.a-of-b.jsonl", "");
  const Ran merged = Shimmer(folder, {"merge", "set"});
  EXPECT_EQ(merged.exit_code, 1);
  EXPECT_EQ(merged.out, "set: 3 of 7 clips done, 0 failed\n4 clips missing\n");
}

// A data set may come from anywhere.
TEST(Shards, WriteNothingOutside) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf("sequence"));
  ExpectDone(Generate(folder, "c.json", "in/a"));
  folder.Put("treasure", "mine");
  std::string manifest = ReadText(folder / "in/a/manifest.jsonl");
  for (const std::string& path : Words{"../../treasure", folder / "treasure", "dataset.json"}) {
    std::string changed = manifest;
    const std::string own = "clips/000000/turb/0000.png";
    changed.replace(changed.find(own), own.size(), path);
    dataset::WriteFile(folder / "in/a/manifest.jsonl", dataset::AsBytes(changed));
    fs::remove_all(folder / "in/b");
    ExpectOneLine(Shimmer(folder, {"merge", "in/b", "in/a"}), 1, {"in/a: its manifest names '" + path + "'"});
    EXPECT_EQ(ReadText(folder / "treasure"), "mine");
  }
}

// A run that finds nothing to do does nothing.
TEST(Shards, AFinishedSetIsNotDrawnAgain) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf("sequence"));
  ExpectDone(Generate(folder, "c.json", "set"));
  const auto report = fs::last_write_time(folder / "set/report.html"),
             manifest = fs::last_write_time(folder / "set/manifest.jsonl");
  ExpectDone(Generate(folder, "c.json", "set"));
  EXPECT_EQ(fs::last_write_time(folder / "set/report.html"), report);
  EXPECT_EQ(fs::last_write_time(folder / "set/manifest.jsonl"), manifest);
}

TEST(Shards, AreSaidAsIOfN) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf("sequence"));
  for (const char* bad : {"3/3", "-1/3", "1", "1/", "/3", "a/b", "1/0", "1.5/3", "99999999999999999999/3"})
    ExpectOneLine(Generate(folder, "c.json", "set", {"--shard", bad}), 2, {std::string(bad), "must be i/N"});
  EXPECT_FALSE(fs::exists(folder / "set"));
}

// SLURM_ARRAY_TASK_ID, _COUNT, _MIN and _STEP, as Slurm sets them for --array=10-18:4.
TEST(Shards, OfASlurmTask) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf("sequence"));
  ExpectOneLine(Generate(folder, "c.json", "set", {"--shard", "slurm"}), 2,
                {"SLURM_ARRAY_TASK_ID is not set"});
  setenv("SLURM_ARRAY_TASK_COUNT", "3", 1);
  setenv("SLURM_ARRAY_TASK_MIN", "10", 1);
  setenv("SLURM_ARRAY_TASK_STEP", "4", 1);
  setenv("SLURM_ARRAY_TASK_ID", "14", 1);
  ExpectDone(Generate(folder, "c.json", "set", {"--shard", "slurm"}));
  setenv("SLURM_ARRAY_TASK_ID", "15", 1);  // of an array of scattered numbers
  const Ran scattered = Generate(folder, "c.json", "set", {"--shard", "slurm"});
  for (const char* name : {"ID", "COUNT", "MIN", "STEP"})
    unsetenv((std::string("SLURM_ARRAY_TASK_") + name).c_str());
  ExpectOneLine(scattered, 2, {"task 15", "consecutive numbers"});
  EXPECT_EQ(dataset::DatasetReader(folder / "set").clips(), (std::set<int64_t>{1, 4}));
  EXPECT_TRUE(fs::exists(folder / "set/manifest.001-of-003.jsonl"));
}

}  // namespace
}  // namespace shimmer::app
