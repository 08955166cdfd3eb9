// Fault 1 of --retry-failed: killed at any moment, what the manifest names is whole. Tars are written anew
// for it, so that members of other clips move.
#include <algorithm>

#include "tests/app/sets.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

class KilledRetry : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Layouts, KilledRetry, testing::Values("sequence", "pairs", "webdataset"),
                         [](const auto& info) { return info.param; });

// What lies in the set but for the manifest: its lines are in the order of the attempts.
std::map<std::string, std::string> TreeOfFiles(const fs::path& set) {
  auto tree = WholeTree(set);
  tree.erase("manifest.jsonl");
  return tree;
}

TEST_P(KilledRetry, AtAnyMomentWhatTheManifestNamesIsWhole) {
  const TempFolder folder;
  WritePng(folder, "in/good.png", dataset::RandomImage({40, 30}, 3, 1));
  WritePng(folder, "late.png", dataset::RandomImage({40, 30}, 3, 2));
  fs::create_symlink("../nowhere", folder / "in/late.png");
  folder.Put("c.json", SetConfig(GetParam(), 24, {{"source", {{"images", "in"}}}}));
  EXPECT_EQ(RunForked(folder, GenerateWords("c.json", "first")).exit_code, 1);
  fs::remove(folder / "in/late.png");
  fs::rename(folder / "late.png", folder / "in/late.png");
  ExpectDone(RunForked(folder, GenerateWords("c.json", "whole")));
  const auto whole = TreeOfFiles(folder / "whole");

  const Words retry = GenerateWords("c.json", "set", {"--retry-failed"});
  const auto put_back = [&] {
    fs::remove_all(folder / "set");
    fs::copy(folder / "first", folder / "set", fs::copy_options::recursive);
  };
  put_back();
  // Moments between which what is there changes.
  const std::string calls = "rename,fsync,syncfs";
  FaultyRun unkilled(folder.path(), retry, {.root = folder / "set", .calls = calls});
  ExpectDone(unkilled.Wait());
  EXPECT_EQ(Differing(whole, TreeOfFiles(folder / "set")), Words());

  const int64_t kills = std::min<int64_t>(Times(15, 150), unkilled.calls());
  for (int64_t kill = 0; kill < kills; ++kill) {
    put_back();
    const int64_t call = unkilled.calls() - kill * unkilled.calls() / kills;
    FaultyRun run(folder.path(), retry, {.root = folder / "set", .calls = calls, .mode = "kill", .at = call});
    run.Wait();
    const Ran plain = RunForked(folder, GenerateWords("c.json", "set"));  // which tries nothing again
    EXPECT_LE(plain.exit_code, 1) << plain.err;
    EXPECT_EQ(BrokenFiles(folder / "set"), Words()) << "before call " << call;
    ExpectDone(RunForked(folder, retry));
    EXPECT_EQ(BrokenFiles(folder / "set"), Words()) << "before call " << call;
    EXPECT_EQ(Differing(whole, TreeOfFiles(folder / "set")), Words()) << "before call " << call;
  }
  Tell("1 kill, --retry-failed, " + GetParam() + ": " + std::to_string(kills) + " kills of " +
       std::to_string(unkilled.calls()) + " calls, all sets whole");
}

}  // namespace
}  // namespace shimmer::app
