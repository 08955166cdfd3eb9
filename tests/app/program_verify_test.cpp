// shimmer verify: whatever happened to a data set is found, and undone.
#include "sim/dataset/folder_lock.h"
#include "tests/app/harm.h"

namespace shimmer::app {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

// Of a layout, with truth.
std::string ConfigOf(const std::string& layout, const Json& changes = Json::object()) {
  Json output = {{"layout", layout},
                 {"truth", {"tilt", "sigma"}},
                 {"any_length", true},
                 {"test_fraction", 0.3},
                 {"tar_mb", 1}};
  if (layout == "pairs" || layout == "restormer") output["frames_per_clip"] = 3;
  Json config = {{"clips", 14}, {"frames", 3}, {"output", output}};
  config.update(changes);
  return SmallConfig(config);
}

Ran Verify(const TempFolder& folder, const Words& more = {}) {
  Words words = {"verify", "set"};
  words.insert(words.end(), more.begin(), more.end());
  return Shimmer(folder, words);
}

// The last line that was printed.
std::string Summary(const Ran& ran) {
  const size_t end = ran.out.size() - 1, start = ran.out.rfind('\n', end - 1);
  return ran.out.substr(start == std::string::npos ? 0 : start + 1, end - start - 1);
}

void ExpectWhole(const Ran& ran, const std::string& summary) {
  EXPECT_EQ(ran.exit_code, 0) << ran.out << ran.err;
  EXPECT_EQ(ran.out, summary + "\n");
}

// Fault 14 in small, for layouts of files: 14 clips of 3 frames are 98 files or more.
TEST(Verify, FindsAndUndoesSilentRot) {
  for (const std::string format : {"png", "exr"})
    for (const std::string layout : {"sequence", "pairs", "restormer", "basicsr"}) {
      const TempFolder folder;
      folder.Put("c.json", ConfigOf(layout));
      ExpectDone(Generate(folder, "c.json", "set", {"--set", "output.format=" + format}));
      Harm harm(folder / "set", 7);
      harm.Do({.flipped = 40, .deleted = 8, .swapped_pairs = 8, .truncated = 8, .surplus = 4});
      const Ran found = Verify(folder);
      harm.ExpectFound(found);
      EXPECT_EQ(Verify(folder, {"--threads", "1"}).out, found.out);
      const Ran repaired = Verify(folder, {"--repair"});
      EXPECT_EQ(repaired.exit_code, 0) << repaired.err;
      EXPECT_THAT(Summary(repaired), HasSubstr("14 of 14 clips whole")) << layout;
      EXPECT_THAT(Summary(repaired), HasSubstr(" 0 problems"));
      harm.ExpectUndone();
    }
}

// The same for tars, three clips each.
TEST(Verify, FindsAndUndoesSilentRotOfTars) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf("webdataset", {{"clips", 84}, {"frames", 1}, {"size", {128, 96}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  ASSERT_EQ(NamesIn(folder / "set/shards").size(), 29u);  // index.json too
  Harm harm(folder / "set", 7);
  harm.Do({.flipped = 15, .deleted = 3, .swapped_pairs = 3, .truncated = 3, .surplus = 4});
  harm.ExpectFound(Verify(folder));
  EXPECT_EQ(Verify(folder, {"--repair", "--quiet"}).exit_code, 0);
  harm.ExpectUndone();
}

TEST(Verify, CountsWhatIsWhole) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf("sequence"));
  ExpectDone(Generate(folder, "c.json", "set"));
  ExpectWhole(Verify(folder), "set: 14 of 14 clips whole, 98 files, 0 problems");
  fs::remove(folder / "set/clips/000003/turb/0001.png");
  Ran ran = Verify(folder);
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_EQ(ran.out, "clips/000003/turb/0001.png: missing\nset: 13 of 14 clips whole, 98 files, 1 problem\n");
  ran = Verify(folder, {"--quiet"});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_EQ(ran.out, "set: 13 of 14 clips whole, 98 files, 1 problem\n");
  EXPECT_EQ(ran.err, "");
}

TEST(Verify, NamesEveryOneOfManyProblems) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"clips", 1}, {"frames", 1}, {"size", {2, 2}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  for (int i = 0; i < 1502; ++i) folder.Put("set/" + std::to_string(i), "x");
  const Ran ran = Verify(folder);
  EXPECT_EQ(std::ranges::count(ran.out, '\n'), 1502 + 1);
  EXPECT_THAT(ran.out, HasSubstr("\nset: 1 of 1 clip whole, 2 files, 1,502 problems\n"));
}

TEST(Verify, AFolderWithoutADataSetIsWrongInput) {
  const TempFolder folder;
  ExpectOneLine(Verify(folder), 2, {"set: not a data set (no dataset.json in it)"});
  folder.Put("set/thesis.tex", "x");
  ExpectOneLine(Verify(folder, {"--repair"}), 2, {"set: not a data set"});
  EXPECT_EQ(NamesIn(folder / "set"), std::set<std::string>{"thesis.tex"});
  ExpectOneLine(Shimmer(folder, {"verify"}), 2, {"DIR"});
}

TEST(Verify, SaysAtOnceThatSomeoneWrites) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  ExpectDone(Generate(folder, "c.json", "set"));
  for (const dataset::Shard& shard : {dataset::Shard{}, dataset::Shard{1, 3}}) {
    const dataset::FolderLock lock(folder / "set", shard);
    for (const Words& words : {Words{}, Words{"--repair"}})
      ExpectOneLine(Verify(folder, words), 1, {"set: process " + std::to_string(getpid()), "writes to"});
  }
  EXPECT_EQ(Verify(folder).exit_code, 0);
}

// An archive on a medium that can't be written to.
TEST(Verify, AReadOnlySetIsVerified) {
  if (geteuid() != 0) GTEST_SKIP() << "needs root, to be somebody else";
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"clips", 1}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  fs::permissions(folder.path(), fs::perms{0755});
  const Ran ran = Running(folder.path(), {"verify", "set", "--quiet"}, /*as_nobody=*/true).Wait();
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  fs::remove(folder / "set/clips/000000/turb/0000.png");
  const Ran repair = Running(folder.path(), {"verify", "set", "--quiet", "--repair"}, true).Wait();
  EXPECT_EQ(repair.exit_code, 1);
  EXPECT_THAT(repair.err, HasSubstr("Permission denied"));
}

TEST(Verify, MissingClipsAreMadeByRepair) {
  for (const std::string layout : {"sequence", "pairs", "webdataset"}) {
    const TempFolder folder;
    folder.Put("c.json", ConfigOf(layout, {{"clips", 5}}));
    ExpectDone(Generate(folder, "c.json", "whole"));
    ExpectDone(Generate(folder, "c.json", "set", {"--clip", "3"}));
    ExpectDone(Generate(folder, "c.json", "set", {"--clip", "1"}));
    const Ran before = Verify(folder);
    if (layout != "webdataset") {  // of which one tar holds all five
      EXPECT_EQ(before.exit_code, 1);
      EXPECT_THAT(before.out, HasSubstr("clip 0: missing: neither done nor failed\nclip 2: missing"));
    }
    EXPECT_EQ(Verify(folder, {"--repair"}).exit_code, 0);
    EXPECT_THAT(Differing(Tree(folder / "set"), Tree(folder / "whole")),
                IsEmpty());  // the manifest's order too
  }
}

TEST(Verify, DamagedLinesAreMadeAgain) {
  for (const std::string layout : {"sequence", "restormer", "webdataset"}) {
    const TempFolder folder;
    folder.Put("c.json", ConfigOf(layout, {{"clips", 5}}));
    ExpectDone(Generate(folder, "c.json", "set"));
    const auto whole = Tree(folder / "set");
    const auto inodes = Inodes(folder / "set");
    std::string manifest = whole.at("manifest.jsonl");
    manifest[manifest.find('\n') + 1] = '[';  // the second line
    manifest.resize(manifest.size() - 10);    // and the last one
    dataset::WriteFile(folder / "set/manifest.jsonl", dataset::AsBytes(manifest));
    const Ran found = Verify(folder);
    EXPECT_EQ(found.exit_code, 1);
    EXPECT_THAT(found.out, HasSubstr("\nmanifest.jsonl:2: damaged line ("));
    EXPECT_THAT(found.out, HasSubstr("\nmanifest.jsonl: its last line is torn\n"));
    EXPECT_THAT(found.out, HasSubstr("clip 1: missing"));
    EXPECT_THAT(found.out, HasSubstr("clip 4: missing"));
    EXPECT_THAT(found.out, HasSubstr(", 4 problems\n"));
    EXPECT_EQ(Verify(folder, {"--repair"}).exit_code, 0);
    EXPECT_THAT(Differing(Tree(folder / "set"), whole), IsEmpty());
    // Files were right, and stay; tars are written whole.
    if (layout != "webdataset") {
      EXPECT_THAT(Touched(inodes, folder / "set"), IsEmpty());
    }
  }
}

// A wrong hash in a line that is JSON: the clip is made again, and a new line says what is true.
TEST(Verify, AWrongLineIsWrittenAnew) {
  for (const std::string layout : {"sequence", "webdataset"}) {
    const TempFolder folder;
    folder.Put("c.json", ConfigOf(layout, {{"clips", 3}}));
    ExpectDone(Generate(folder, "c.json", "set"));
    const auto whole = Tree(folder / "set");
    std::string manifest = whole.at("manifest.jsonl");
    const size_t hash = manifest.find("sha256\":\"", manifest.find("\"files\"")) + 9;
    manifest[hash] = manifest[hash] == '0' ? '1' : '0';
    dataset::WriteFile(folder / "set/manifest.jsonl", dataset::AsBytes(manifest));
    EXPECT_THAT(Verify(folder).out, HasSubstr("damaged: its SHA-256 is not that of the manifest"));
    EXPECT_EQ(Verify(folder, {"--repair"}).exit_code, 0);
    EXPECT_THAT(Differing(Tree(folder / "set"), whole), IsEmpty());
  }
}

TEST(Verify, ShardsAreUnitedByRepair) {
  for (const std::string layout : {"sequence", "webdataset"}) {
    const TempFolder folder;
    folder.Put("c.json", ConfigOf(layout, {{"clips", 5}}));
    ExpectDone(Generate(folder, "c.json", "whole"));
    for (const char* shard : {"0/2", "1/2"})
      ExpectDone(Generate(folder, "c.json", "set", {"--shard", shard}));
    if (layout == "sequence") {
      dataset::WriteFile(folder / "set/clips/000002/turb/0000.png", {});
      fs::remove_all(folder / "set/clips/000003");
      EXPECT_THAT(Summary(Verify(folder)), HasSubstr("3 of 5 clips whole"));
    }
    EXPECT_EQ(Verify(folder, {"--repair"}).exit_code, 0);
    EXPECT_THAT(Differing(Tree(folder / "set"), Tree(folder / "whole")), IsEmpty());
  }
}

TEST(Verify, DerivedFilesAreWrittenAnew) {
  for (const auto& [layout, path] :
       std::vector<std::pair<std::string, std::string>>{{"restormer", "shimmer/restormer.yml"},
                                                        {"basicsr", "meta_info.txt"},
                                                        {"webdataset", "shards/index.json"}}) {
    const TempFolder folder;
    folder.Put("c.json", ConfigOf(layout, {{"clips", 4}}));
    ExpectDone(Generate(folder, "c.json", "set"));
    const auto whole = Tree(folder / "set");
    const auto inodes = Inodes(folder / "set");
    dataset::WriteFile(folder / "set" / path, dataset::AsBytes(std::string("{")));
    EXPECT_THAT(Verify(folder).out, HasSubstr(path + ": damaged: says something else than the manifest\n"));
    EXPECT_EQ(Verify(folder, {"--repair"}).exit_code, 0);
    EXPECT_THAT(Differing(Tree(folder / "set"), whole), IsEmpty());
    EXPECT_EQ(Touched(inodes, folder / "set"), Words{path});
  }
}

// An earlier run's `clips` may have been larger: those are part of the set.
TEST(Verify, ClipsBeyondTheConfigsAreVerifiedToo) {
  for (const std::string layout : {"sequence", "webdataset"}) {
    const TempFolder folder;
    folder.Put("c.json", ConfigOf(layout, {{"clips", 5}}));
    ExpectDone(Generate(folder, "c.json", "set"));
    ExpectDone(Generate(folder, "c.json", "set", {"--set", "clips=3"}));
    const auto whole = Tree(folder / "set");
    EXPECT_THAT(Summary(Verify(folder)), HasSubstr("5 of 5 clips whole"));
    const std::string path = layout == "sequence" ? "clips/000004/turb/0001.png" : "shards/000000.tar";
    fs::remove(folder / "set" / path);
    const Ran ran = Verify(folder, {"--repair", "--quiet"});
    if (layout == "sequence") {
      EXPECT_EQ(ran.exit_code, 0);
      EXPECT_THAT(Differing(Tree(folder / "set"), whole), IsEmpty());
    } else {
      EXPECT_EQ(ran.exit_code, 1);
      EXPECT_THAT(ran.err, HasSubstr("holds clip 4, and `clips` is 3; generate with more clips first"));
    }
  }
}

TEST(Verify, WhatAKillHasLeftIsClearedByRepair) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf("pairs", {{"clips", 3}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  folder.Put("set/.staging/7/turb/0000.png", "x");
  EXPECT_THAT(Verify(folder).out, HasSubstr(".staging: surplus: what a run that was killed has left\n"));
  EXPECT_EQ(Verify(folder, {"--repair"}).exit_code, 0);
  EXPECT_EQ(NamesIn(folder / "set"),
            (std::set<std::string>{".lock", "dataset.json", "manifest.jsonl", "report.html", "shimmer"}));
}

// A link in the place of a file or folder is moved away; what it leads to is not touched.
TEST(Verify, LinksAreMovedAndNotFollowed) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf("sequence", {{"clips", 3}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  const auto whole = Tree(folder / "set");
  fs::rename(folder / "set/clips/000001", folder / "elsewhere");
  fs::create_symlink(folder / "elsewhere", folder / "set/clips/000001");
  fs::remove(folder / "set/clips/000002/turb/0000.png");
  fs::create_symlink(folder / "elsewhere/turb/0000.png", folder / "set/clips/000002/turb/0000.png");
  fs::remove(folder / "set/clips/000002/turb/0001.png");
  fs::create_directories(folder / "set/clips/000002/turb/0001.png/sub");
  const auto elsewhere = Tree(folder / "elsewhere");
  EXPECT_EQ(Verify(folder, {"--repair"}).exit_code, 0);
  EXPECT_THAT(Differing(Tree(folder / "set"), whole), IsEmpty());
  EXPECT_THAT(Differing(Tree(folder / "elsewhere"), elsewhere), IsEmpty());
  EXPECT_TRUE(fs::is_symlink(folder / "set/.surplus/clips/000001"));
  EXPECT_TRUE(fs::is_symlink(folder / "set/.surplus/clips/000002/turb/0000.png"));
}

TEST(Verify, ADamagedDescriptionIsSaidAndNotGuessed) {
  const TempFolder folder;
  folder.Put("c.json", ConfigOf("pairs", {{"clips", 3}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  const std::string whole = ReadText(folder / "set/dataset.json");
  std::string other = whole;
  other.replace(other.find("\"max_sigma_px\": 1"), 17, "\"max_sigma_px\": 2");
  dataset::WriteFile(folder / "set/dataset.json", dataset::AsBytes(other));
  EXPECT_THAT(Verify(folder).out,
              HasSubstr("dataset.json: damaged: config_hash is not that of its config\n"));
  folder.Put("set/notes.txt", "x");
  const Ran ran = Verify(folder, {"--repair", "--quiet"});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("set/dataset.json: is damaged, and nothing says what it was"));
  EXPECT_TRUE(fs::exists(folder / "set/notes.txt"));  // nothing was changed
  EXPECT_EQ(ReadText(folder / "set/dataset.json"), other);
  other = whole;
  other.replace(other.find("\"pair_digits\": 6"), 16, "\"pair_digits\": 7");
  dataset::WriteFile(folder / "set/dataset.json", dataset::AsBytes(other));
  EXPECT_THAT(Verify(folder).out, HasSubstr("dataset.json: damaged: pair_digits is 7, must be 6\n"));
  dataset::WriteFile(folder / "set/dataset.json", dataset::AsBytes(std::string("{")));
  ExpectOneLine(Verify(folder), 1, {"set/dataset.json: damaged"});
}

// Sources that a config names by relative paths are found again from its folder, wherever verify is run.
class VerifySources : public testing::Test {
 protected:
  VerifySources() {
    for (int i = 0; i < 3; ++i)
      WritePng(folder_, "my/photos/" + std::to_string(i) + ".png", dataset::RandomImage({40, 30}, 3, 7 + i));
    folder_.Put("my/c.json", SmallConfig({{"source", {{"images", "photos"}}}, {"clips", 6}}));
    ExpectDone(Generate(folder_, "my/c.json", "set"));
    whole_ = Tree(folder_ / "set");
    Damage();
  }
  void Damage() { dataset::WriteFile(folder_ / "set/clips/000002/turb/0000.png", dataset::AsBytes("x")); }

  TempFolder folder_;
  std::map<std::string, std::string> whole_;
};

TEST_F(VerifySources, AreFoundFromTheConfigsFolder) {
  EXPECT_EQ(Json::parse(ReadText(folder_ / "set/.origin.json")),
            (Json{{"config_folder", fs::canonical(folder_ / "my").string()}}));
  const Ran ran = Shimmer(fs::path("/"), {"verify", (folder_ / "set").string(), "--repair"});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(Differing(Tree(folder_ / "set"), whole_), IsEmpty());
}

TEST_F(VerifySources, MayHaveMovedWithTheConfig) {
  fs::rename(folder_ / "my", folder_ / "your");
  const auto damaged = Tree(folder_ / "set");
  const Ran lost = Verify(folder_, {"--repair", "--quiet"});
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_THAT(lost.err, HasSubstr("set: can't be made again: /source/images: 'photos': nothing found"));
  EXPECT_THAT(Differing(Tree(folder_ / "set"), damaged), IsEmpty());
  fs::remove(folder_ / "set/.origin.json");
  EXPECT_THAT(Verify(folder_, {"--repair", "--quiet"}).err, HasSubstr("--config-folder says so"));
  EXPECT_EQ(Verify(folder_, {"--repair", "--config-folder", "your"}).exit_code, 0);
  EXPECT_THAT(Differing(Tree(folder_ / "set"), whole_), IsEmpty());
}

TEST_F(VerifySources, ThatHaveChangedAreRefused) {
  WritePng(folder_, "my/photos/1.png", dataset::RandomImage({40, 30}, 3, 99));
  folder_.Put("set/notes.txt", "x");
  const auto damaged = Tree(folder_ / "set");
  const Ran ran = Verify(folder_, {"--repair", "--quiet"});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_EQ(ran.err, "shimmer: set: can't be made again: source photos/1.png has changed\n");
  EXPECT_THAT(Differing(Tree(folder_ / "set"), damaged), IsEmpty());
}

// A clip that failed has no files to be damaged; the set is as whole as it was, and not all of it is there.
TEST_F(VerifySources, ThatFailedAreCounted) {
  folder_.Put("my/photos/3.png", "no picture");
  fs::remove_all(folder_ / "set");
  EXPECT_EQ(Generate(folder_, "my/c.json", "set", {"--set", "clips=20"}).exit_code, 1);
  const auto lines = ManifestLines(folder_ / "set");
  const auto failed = std::ranges::count(lines, "failed", [](const Json& line) { return line["status"]; });
  ASSERT_GT(failed, 0);
  const auto whole = Tree(folder_ / "set");
  Ran ran = Verify(folder_);
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_EQ(ran.out, "set: " + std::to_string(20 - failed) + " of 20 clips whole, " + std::to_string(failed) +
                         " failed, " + std::to_string(3 * (20 - failed)) + " files, 0 problems\n");
  int64_t done = 0;
  while (lines[static_cast<size_t>(done)]["status"] != "done") ++done;
  fs::remove_all(folder_ / "set" /
                 fs::path(lines[static_cast<size_t>(done)]["files"][0]["path"]).parent_path());
  ran = Verify(folder_, {"--repair"});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(Summary(ran), HasSubstr(" 0 problems"));
  EXPECT_THAT(Differing(Tree(folder_ / "set"), whole), IsEmpty());
}

}  // namespace
}  // namespace shimmer::app
