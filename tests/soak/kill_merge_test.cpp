// Fault 1 of `shimmer merge`: killed at any moment and given again, it makes the set of a run without shards.
#include <algorithm>

#include "tests/app/sets.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

struct Way {
  const char *name, *layout;
  bool own_folders;  // each shard wrote to a folder of its own
};

class KilledMerge : public testing::TestWithParam<Way> {};
INSTANTIATE_TEST_SUITE_P(Ways, KilledMerge,
                         testing::Values(Way{"PairsOfOneFolder", "pairs", false},
                                         Way{"TarsOfOneFolder", "webdataset", false},
                                         Way{"SequenceOfThree", "sequence", true},
                                         Way{"TarsOfThree", "webdataset", true}),
                         [](const auto& info) { return info.param.name; });

// Three shards of 40 clips below "shards", and the words that merge them into "set", where it has a copy of
// them.
Words PutShards(const TempFolder& folder, const Way& way) {
  folder.Put("c.json", SetConfig(way.layout, 40));
  Words merge = {"merge", "set"};
  for (const char* shard : {"0", "1", "2"}) {
    const std::string out = way.own_folders ? std::string("shards/") + shard : "shards";
    ExpectDone(RunForked(folder, GenerateWords("c.json", out, {"--shard", std::string(shard) + "/3"})));
    if (way.own_folders) merge.push_back(out);
  }
  return merge;
}

void PutBack(const TempFolder& folder, const Way& way) {
  fs::remove_all(folder / "set");
  if (!way.own_folders) fs::copy(folder / "shards", folder / "set", fs::copy_options::recursive);
}

TEST_P(KilledMerge, AtAnyMomentItGoesOnToTheSameSet) {
  const TempFolder folder;
  const Words merge = PutShards(folder, GetParam());
  ExpectDone(RunForked(folder, GenerateWords("c.json", "whole")));
  const auto whole = WholeTree(folder / "whole");

  PutBack(folder, GetParam());
  FaultyRun unkilled(folder.path(), merge, {.root = folder / "set"});
  const Ran ran = unkilled.Wait();
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(Differing(whole, WholeTree(folder / "set")), Words());

  const int64_t kills = std::min<int64_t>(Times(5, 50), unkilled.calls());
  for (int64_t kill = 0; kill < kills; ++kill) {
    PutBack(folder, GetParam());
    const int64_t call = 1 + kill * unkilled.calls() / kills;
    FaultyRun run(folder.path(), merge, {.root = folder / "set", .mode = "kill", .at = call});
    EXPECT_EQ(run.Wait().exit_code, 128 + SIGKILL);
    EXPECT_EQ(BrokenFiles(folder / "set"), Words());
    const Ran again = RunForked(folder, merge);
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(Differing(whole, WholeTree(folder / "set")), Words()) << "before call " << call;
  }
  Tell(std::string("1 kill, merge, ") + GetParam().name + ": " + std::to_string(kills) + " kills over " +
       std::to_string(unkilled.calls()) + " calls, all sets equal");
}

}  // namespace
}  // namespace shimmer::app
