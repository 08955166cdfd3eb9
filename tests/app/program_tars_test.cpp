// Sets of tars whose clips change after a tar was written: clips that failed and are tried again, more clips
// or fewer, shards and sets that know different clips of one tar. A tar is never left with fewer clips than
// it had, and the manifest always says where they lie.
#include "sim/dataset/dataset_folder.h"
#include "tests/app/sets.h"

namespace shimmer::app {
namespace {

using testing::HasSubstr;

// Three tars of 9 clips and less, from two pictures; while a person's drive is away one of them can't be
// read.
class Tars : public testing::Test {
 protected:
  Tars() {
    WritePng(folder_, "in/good.png", dataset::RandomImage({40, 30}, 3, 1));
    WritePng(folder_, "drive/late.png", dataset::RandomImage({40, 30}, 3, 2));
    fs::create_symlink("../drive/late.png", folder_ / "in/late.png");
    folder_.Put("c.json", SetConfig("webdataset", 24, {{"source", {{"images", "in"}}}}));
    ExpectDone(Generate(folder_, "c.json", "whole"));
  }

  void TakeDriveAway() const { fs::rename(folder_ / "drive", folder_ / "away"); }
  void BringDriveBack() const { fs::rename(folder_ / "away", folder_ / "drive"); }

  Ran GenerateWith(const std::string& out, const Words& more) const {
    return Generate(folder_, "c.json", out, more);
  }

  void ExpectWhole(const std::string& set) const {
    EXPECT_EQ(BrokenFiles(folder_ / set), Words());
    EXPECT_EQ(Shimmer(folder_, {"verify", set}).out,
              set + ": 24 of 24 clips whole, " + std::to_string(24 * 6) + " files, 0 problems\n");
    for (const char* tar : {"shards/000000.tar", "shards/000001.tar", "shards/000002.tar"})
      EXPECT_EQ(ReadText(folder_ / set / tar), ReadText(folder_ / "whole" / tar)) << set << " " << tar;
  }

  const TempFolder folder_;
};

TEST_F(Tars, OfShardsAreTriedAgainAsOneSet) {
  TakeDriveAway();
  for (const char* shard : {"0/2", "1/2"})
    EXPECT_EQ(GenerateWith("set", {"--shard", shard}).exit_code, 1) << shard;
  BringDriveBack();
  ExpectDone(GenerateWith("set", {"--retry-failed"}));
  ExpectWhole("set");
  EXPECT_EQ(Shimmer(folder_, {"merge", "set"}).exit_code, 0);
  ExpectWhole("set");
}

TEST_F(Tars, OfShardsOfAnotherCountAreMergedFirst) {
  ExpectDone(GenerateWith("set", {"--shard", "0/2"}));
  ExpectOneLine(GenerateWith("set", {"--shard", "0/4"}), 2,
                {"set: shards of 2 have written tars", "manifest.000-of-002.jsonl", "shimmer merge"});
  const Ran merged = Shimmer(folder_, {"merge", "set"});
  EXPECT_THAT(merged.out, HasSubstr("shard 1/2: 9 clips missing"));
  ExpectDone(GenerateWith("set", {"--shard", "1/4"}));
  EXPECT_EQ(Shimmer(folder_, {"merge", "set"}).exit_code, 0);
  ExpectWhole("set");
}

TEST_F(Tars, FewerClipsTakeNoneAway) {
  TakeDriveAway();
  EXPECT_EQ(GenerateWith("set", {}).exit_code, 1);
  BringDriveBack();
  ExpectDone(GenerateWith("set", {"--retry-failed", "--set", "clips=20"}));
  EXPECT_EQ(DoneClips(folder_ / "set").size(), 24u);
  ExpectDone(GenerateWith("set", {}));
  ExpectWhole("set");
}

TEST_F(Tars, AreLeftAsTheyAreWhereAClipCannotBeMadeAgain) {
  ExpectDone(GenerateWith("set", {"--set", "clips=20"}));
  const auto before = DoneClips(folder_ / "set");
  TakeDriveAway();
  const Ran ran = GenerateWith("set", {});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("set/shards/000002.tar: left as it is, for clip "));
  EXPECT_THAT(ran.err, HasSubstr("can't be made again: in/late.png"));
  EXPECT_EQ(DoneClips(folder_ / "set"), before);
  EXPECT_EQ(BrokenFiles(folder_ / "set"), Words());
  // What the missing picture is like is still known.
  for (const Json& source : dataset::ReadDescription(folder_ / "set").at("sources"))
    EXPECT_TRUE(source.at("sha256").is_string()) << source;
  BringDriveBack();
  ExpectDone(GenerateWith("set", {}));
  ExpectWhole("set");
}

// First one picture is away, then the other: no tar can be made whole, and none loses a clip.
TEST_F(Tars, ThatAreLeftAreCounted) {
  TakeDriveAway();
  EXPECT_EQ(GenerateWith("set", {}).exit_code, 1);
  const auto before = DoneClips(folder_ / "set");
  BringDriveBack();
  fs::rename(folder_ / "in/good.png", folder_ / "good.png");
  fs::create_symlink("../nowhere", folder_ / "in/good.png");
  const Ran ran = GenerateWith("set", {"--retry-failed"});
  ExpectOneLine(
      ran, 1, {"clips failed", "set/shards/000000.tar and 2 more: left as it is, for clip ", "in/good.png"});
  EXPECT_EQ(DoneClips(folder_ / "set"), before);
  EXPECT_EQ(BrokenFiles(folder_ / "set"), Words());
  fs::rename(folder_ / "good.png", folder_ / "in/good.png");
  ExpectDone(GenerateWith("set", {"--retry-failed"}));
  ExpectWhole("set");
}

TEST_F(Tars, OfAnotherSetReplaceThoseThatHaveLess) {
  TakeDriveAway();
  EXPECT_EQ(GenerateWith("less", {}).exit_code, 1);
  BringDriveBack();
  const Ran merged = Shimmer(folder_, {"merge", "less", "whole"});
  EXPECT_EQ(merged.exit_code, 0) << merged.out << merged.err;
  ExpectWhole("less");
  // And the other way nothing is taken over.
  TakeDriveAway();
  EXPECT_EQ(GenerateWith("again", {}).exit_code, 1);
  BringDriveBack();
  EXPECT_EQ(Shimmer(folder_, {"merge", "less", "again"}).exit_code, 0);
  ExpectWhole("less");
}

}  // namespace
}  // namespace shimmer::app
