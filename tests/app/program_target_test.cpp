// The folder that a data set goes to: of another config, of somebody else, not writable, full.
#include <sys/mount.h>

#include "tests/app/program.h"
#include "tests/app/small_disk.h"

namespace shimmer::app {
namespace {

TEST(Target, OfAnotherConfigIsRefusedWithTheDifference) {
  const TempFolder folder;
  WritePng(folder, "in/a.png", dataset::RandomImage({40, 30}, 3, 1));
  folder.Put("c.json", SmallConfig({{"source", {{"images", "in"}}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  const auto before = Tree(folder / "set");
  const std::string refused = "set: holds a data set made from something else: ";
  ExpectOneLine(Generate(folder, "c.json", "set", {"--set", "tilt.strength_px=6"}), 2,
                {refused + "/tilt/strength_px is 5.0 there and 6.0 here"});
  ExpectOneLine(Generate(folder, "c.json", "set", {"--set", "seed=1", "--set", "frames=3"}), 2,
                {"/seed is 0 there and 1 here", "/frames is 2 there and 3 here"});
  WritePng(folder, "in/b.png", dataset::RandomImage({40, 30}, 3, 2));
  ExpectOneLine(Generate(folder, "c.json", "set"), 2, {refused, "in/b.png"});
  fs::remove(folder / "in/b.png");
  WritePng(folder, "in/a.png", dataset::RandomImage({40, 30}, 3, 3));
  ExpectOneLine(Generate(folder, "c.json", "set"), 2, {refused, "in/a.png"});

  // Another engine made it: its pixels would not be ours.
  Json description = Json::parse(before.at("dataset.json"));
  description["engine"] = 0;
  WritePng(folder, "in/a.png", dataset::RandomImage({40, 30}, 3, 1));
  EXPECT_EQ(Tree(folder / "set"), before);
  folder.Put("set/dataset.json", description.dump());
  ExpectOneLine(Generate(folder, "c.json", "set"), 2, {"engine is 0 there"});
}

// Where the command is given from is no part of the config.
TEST(Target, IsTheSameFromAnyWorkingDirectory) {
  const TempFolder folder;
  WritePng(folder, "in/a.png", dataset::RandomImage({40, 30}, 3, 1));
  WritePng(folder, "else/b.png", dataset::RandomImage({40, 30}, 3, 2));
  folder.Put("c.json", SmallConfig({{"source", {{"images", {"in", (folder / "else").string()}}}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  const auto before = Tree(folder / "set");
  ExpectDone(Shimmer("/", {"generate", folder / "c.json", "--out", folder / "set", "--quiet"}));
  ExpectDone(Shimmer(folder / "in", {"generate", "../c.json", "--out", "../set", "--quiet"}));
  EXPECT_EQ(Tree(folder / "set"), before);
  // Where a picture lies outside the config's folder its name is absolute.
  fs::create_directory(folder / "configs");
  folder.Put("configs/c.json", SmallConfig({{"source", {{"images", {"../in", "../else"}}}}}));
  ExpectDone(Generate(folder, "configs/c.json", "other"));
  const Json sources = dataset::DatasetReader(folder / "other").description().at("sources");
  EXPECT_EQ(sources.at(0).at("path"), (folder / "else/b.png").string());
}

// However a picture's place is spelled, and however often: it is one source.
TEST(Target, IsTheSameForEverySpellingOfASource) {
  const TempFolder folder;
  for (const char* name : {"a.png", "b.png", "c.png"})
    WritePng(folder, std::string("in/") + name, dataset::RandomImage({40, 30}, 3, name[0]));
  fs::create_directory_symlink(folder / "in", folder / "link");
  folder.Put("c.json",
             SmallConfig({{"clips", 6},
                          {"source", {{"images", {"in/a.png", (folder / "in/*.png").string(), "link"}}}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  EXPECT_EQ(dataset::DatasetReader(folder / "set").description().at("sources").size(), 3u);
  const auto before = Tree(folder / "set");
  ExpectDone(Shimmer("/", {"generate", folder / "c.json", "--out", folder / "set", "--quiet"}));
  EXPECT_EQ(Tree(folder / "set"), before);
  ExpectDone(Shimmer("/", {"generate", folder / "c.json", "--out", folder / "other", "--quiet"}));
  EXPECT_EQ(Tree(folder / "other"), before);
}

// What a run has made is no source of the next, though the pattern finds it.
TEST(Target, BelowTheSourcesIsNoSource) {
  const TempFolder folder;
  WritePng(folder, "a.png", dataset::RandomImage({40, 30}, 3, 1));
  folder.Put("c.json", SmallConfig({{"source", {{"images", "**/*.png"}}}}));
  for (int run = 0; run < 2; ++run) ExpectDone(Generate(folder, "c.json", "set"));
  const Json sources = dataset::DatasetReader(folder / "set").description().at("sources");
  EXPECT_EQ(sources.size(), 1u);
}

TEST(Target, OfSomebodyElseIsLeftAlone) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  folder.Put("mine/thesis.txt", "text");
  ExpectOneLine(Generate(folder, "c.json", "mine"), 2, {"mine: holds other files (thesis.txt)"});
  EXPECT_EQ(NamesIn(folder / "mine"), std::set<std::string>{"thesis.txt"});
  ExpectOneLine(Generate(folder, "c.json", "c.json"), 2, {"c.json: is a file, must be a folder"});
  EXPECT_EQ(ReadText(folder / "c.json"), SmallConfig());
}

TEST(Target, BelowAFileCantBeMade) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  ExpectOneLine(Generate(folder, "c.json", "c.json/set"), 1, {"c.json", "can't be made"});
  EXPECT_EQ(ReadText(folder / "c.json"), SmallConfig());
}

TEST(Target, IsMadeWithItsParents) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  ExpectDone(Generate(folder, "c.json", "some/where/set/"));
  EXPECT_EQ(dataset::DatasetReader(folder / "some/where/set").clips().size(), 4u);
}

// One writer at a time: the other says so, and both sets are whole in the end.
TEST(Target, HasOneWriterAtATime) {
  const TempFolder folder;
  // slow enough for the second to find the first at work
  folder.Put("c.json", SmallConfig({{"clips", 40},
                                    {"size", {200, 160}},
                                    {"blur", {{"max_sigma_px", 4}, {"method", "exact"}}}}));
  const Words command = {"generate", "c.json", "--out", "set", "--quiet"};
  Running first(folder.path(), command);
  WaitUntil([&] { return fs::exists(folder / "set/manifest.jsonl"); });
  const Ran second = Shimmer(folder, command);
  ExpectDone(first.Wait());
  ExpectOneLine(second, 1, {"set: process ", " writes to this data set; wait for it to end"});
  EXPECT_EQ(ManifestLines(folder / "set").size(), 40u);
}

// Whatever it is that finds no place, what is finished stays, and a run with more room completes the set.
TEST(Target, ThatIsFull) {
  for (const char* layout : {"sequence", "pairs"}) {
    const TempFolder folder;
    folder.Put("c.json", SmallConfig({{"clips", 12}, {"size", {40, 40}}, {"output", {{"layout", layout}}}}));
    ExpectDone(Generate(folder, "c.json", "whole"));
    const auto whole = Tree(folder / "whole");
    for (const char* size : {"4k", "12k", "40k", "72k"}) {
      SmallDisk disk(folder / "disk", std::string("size=") + size);
      if (!disk.mounted()) GTEST_SKIP() << "no right to mount a small file system";
      ExpectOneLine(Generate(folder, "c.json", "disk/set"), 1, {"disk/set", "No space left on device"});
      for (const auto& [path, content] : Tree(folder / "disk"))
        EXPECT_TRUE(!path.ends_with(".png") || content == whole.at(path.substr(4))) << path;
      disk.Enlarge("size=4m");
      ExpectDone(Generate(folder, "c.json", "disk/set"));
      EXPECT_EQ(Tree(folder / "disk/set"), whole) << layout << " " << size;
    }
  }
}

TEST(Target, ThatCantBeWritten) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  SmallDisk disk(folder / "disk", "size=1m");
  if (!disk.mounted() || mount("tmpfs", (folder / "disk").c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, "") != 0)
    GTEST_SKIP() << "no right to mount a file system";
  ExpectOneLine(Generate(folder, "c.json", "disk/set"), 1, {"disk/set", "Read-only file system"});
}

}  // namespace
}  // namespace shimmer::app
