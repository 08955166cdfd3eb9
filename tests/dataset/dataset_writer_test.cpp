#include "sim/dataset/dataset_writer.h"

#include <thread>

#include "tests/dataset/small_set.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

template <class Error = std::runtime_error>
std::string ErrorOfOpening(const fs::path& folder, const Json& description) {
  return ErrorOf<Error>([&] { DatasetWriter(folder, Sequence(), description); });
}

// The caller's fault: it should have named another folder.
std::string ReasonOfRefusal(const fs::path& folder, const Json& description) {
  return ErrorOfOpening<std::invalid_argument>(folder, description);
}

TEST(DatasetWriter, ACommittedClipIsThereAndInTheManifest) {
  for (const Layout& layout : {Sequence(), Pairs()}) {
    const TempFolder folder;
    DatasetWriter writer(folder / "new/set", layout, Description());
    EXPECT_TRUE(writer.done().empty());
    const auto files = SmallClip(layout, 3);
    CommitNow(writer, 3, files, {{"plan", "p"}});
    EXPECT_EQ(writer.done(), std::set<int64_t>{3});

    auto tree = Tree(folder / "new/set");
    EXPECT_EQ(tree.size(), files.size() + 2);
    const Json line = Json::parse(tree["manifest.jsonl"]);
    EXPECT_EQ(line["clip"], 3);
    EXPECT_EQ(line["status"], "done");
    EXPECT_EQ(line["plan"], "p");
    ASSERT_EQ(line["files"].size(), files.size());
    for (size_t i = 0; i < files.size(); ++i) {
      EXPECT_EQ(line["files"][i]["path"], files[i].path);
      EXPECT_EQ(line["files"][i]["pixels"], files[i].pixel_hash);
      EXPECT_EQ(line["files"][i]["sha256"], Sha256Hex(files[i].bytes));
      EXPECT_EQ(tree[files[i].path], "bytes of " + files[i].path);
    }
    EXPECT_EQ(Json::parse(tree["dataset.json"]), Description());
  }
}

TEST(DatasetWriter, NothingButTheSetIsLeft) {
  const TempFolder folder;
  {
    DatasetWriter writer(folder.path(), Sequence(), Description());
    CommitNow(writer, 0, SmallClip(Sequence(), 0), {});
  }
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path())) names.insert(entry.path().filename());
  EXPECT_EQ(names, (std::set<std::string>{".lock", "clips", "dataset.json", "manifest.jsonl"}));
}

TEST(DatasetWriter, ContinuesWhereItStopped) {
  const TempFolder folder;
  {
    DatasetWriter writer(folder.path(), Sequence(), Description());
    CommitNow(writer, 0, SmallClip(Sequence(), 0), {});
    FailNow(writer, 1, {{"error", "bad source"}});
  }
  DatasetWriter writer(folder.path(), Sequence(), Description());
  EXPECT_EQ(writer.done(), std::set<int64_t>{0});
  EXPECT_EQ(writer.failed(), std::set<int64_t>{1});
  CommitNow(writer, 1, SmallClip(Sequence(), 1), {});  // a failed clip may be tried again
  EXPECT_EQ(writer.done(), (std::set<int64_t>{0, 1}));
  EXPECT_TRUE(writer.failed().empty());
  EXPECT_THROW(CommitNow(writer, 0, SmallClip(Sequence(), 0), {}), std::invalid_argument);
  EXPECT_EQ(Manifest(folder / "manifest.jsonl").done(), (std::set<int64_t>{0, 1}));
}

TEST(DatasetWriter, DifferencesAreNamed) {
  const TempFolder folder;
  { DatasetWriter writer(folder.path(), Sequence(), Description()); }
  const auto error_with = [&](const std::string& pointer, const Json& value) {
    Json other = Description();
    other[Json::json_pointer(pointer)] = value;
    return ReasonOfRefusal(folder.path(), other);
  };
  EXPECT_TRUE(Contains(error_with("/config/tilt/strength_px", 6), "/tilt/strength_px is 5 there and 6 here"));
  EXPECT_TRUE(Contains(
      error_with("/config/tilt/strength_px", Json{{"uniform", {1, 2}}}),
      "/tilt/strength_px is 5 there and absent here; /tilt/strength_px/uniform/0 is absent there and 1"));
  EXPECT_TRUE(Contains(error_with("/config/size/1", 128), "/size/1 is 256 there and 128 here"));
  EXPECT_TRUE(Contains(error_with("/engine", 2), "engine is 1 there and 2 here"));
  EXPECT_TRUE(Contains(error_with("/sources/1/sha256", "cc"), "source b.jpg has changed"));
  const std::string moved = error_with("/sources/1/path", "c.jpg");
  EXPECT_TRUE(Contains(moved, "source b.jpg is gone") && Contains(moved, "source c.jpg was added")) << moved;
  EXPECT_TRUE(Contains(moved, folder.path().string())) << moved;
  // What may differ: the number of clips, and what is for people only.
  EXPECT_EQ(error_with("/config/clips", 20), "");
  EXPECT_EQ(error_with("/version", "0.2.0"), "");
}

TEST(DatasetWriter, ManyDifferencesAreCounted) {
  const TempFolder folder;
  { DatasetWriter writer(folder.path(), Sequence(), Description()); }
  Json other = Description();
  for (int i = 0; i < 100; ++i) other["sources"].push_back({{"path", std::to_string(i)}, {"sha256", "x"}});
  EXPECT_TRUE(Contains(ReasonOfRefusal(folder.path(), other), "and 92 more"));
}

// Layout pairs: the length of the numbers in file names must not change, or their order would.
TEST(DatasetWriter, RefusesOtherNumbersInFileNames) {
  const TempFolder folder;
  Json description = Description();
  description["pair_digits"] = 6;
  EXPECT_EQ(ErrorOfOpening(folder.path(), description), "");
  description["pair_digits"] = 9;
  EXPECT_TRUE(Contains(ReasonOfRefusal(folder.path(), description), "6 digits there and would have 9 here"));
}

// A source that could not be read has no hash; it may stay so, and be read the next time.
TEST(DatasetWriter, KnowsSourcesWithoutAHash) {
  const TempFolder folder;
  Json description = Description();
  description["sources"] = {{{"path", "bad.png"}, {"sha256", nullptr}}};
  EXPECT_EQ(ErrorOfOpening(folder.path(), description), "");
  EXPECT_EQ(ErrorOfOpening(folder.path(), description), "");
  description["sources"] = {{{"path", "bad.png"}, {"sha256", "00"}}};
  EXPECT_EQ(ErrorOfOpening(folder.path(), description), "");
  description["sources"] = {{{"path", "bad.png"}, {"sha256", "11"}}};
  EXPECT_TRUE(Contains(ReasonOfRefusal(folder.path(), description), "bad.png has changed"));
}

TEST(DatasetWriter, TheNumberOfClipsIsKeptUpToDate) {
  const TempFolder folder;
  { DatasetWriter writer(folder.path(), Sequence(), Description()); }
  Json more = Description();
  more["config"]["clips"] = 20;
  { DatasetWriter writer(folder.path(), Sequence(), more); }
  EXPECT_EQ(Json::parse(Tree(folder.path())["dataset.json"])["config"]["clips"], 20);
}

TEST(DatasetWriter, OtherPeoplesFilesAreLeftAlone) {
  const TempFolder folder;
  folder.Put("thesis.tex", "x");
  const auto before = Tree(folder.path());
  EXPECT_TRUE(Contains(ReasonOfRefusal(folder.path(), Description()), "thesis.tex"));
  EXPECT_EQ(Tree(folder.path()), before);
  EXPECT_FALSE(fs::exists(folder / ".lock"));
  EXPECT_TRUE(Contains(ReasonOfRefusal(folder / "thesis.tex", Description()), "is a file"));
  // Our own leftovers of a kill at the very start are no such files.
  const TempFolder ours;
  ours.Put(".staging/0/turb/0000.png", "x");
  ours.Put(".staging/dataset.json", "{");
  EXPECT_EQ(ErrorOfOpening(ours.path(), Description()), "");
  EXPECT_FALSE(fs::exists(ours / ".staging"));
}

TEST(DatasetWriter, ADamagedDescriptionIsNotOverwritten) {
  const TempFolder folder;
  folder.Put("dataset.json", "{\"config\"");
  EXPECT_TRUE(Contains(ErrorOfOpening(folder.path(), Description()), "dataset.json: damaged"));
  EXPECT_EQ(Tree(folder.path())["dataset.json"], "{\"config\"");
}

TEST(DatasetWriter, OneProcessAtATime) {
  const TempFolder folder;
  {
    DatasetWriter first(folder.path(), Sequence(), Description());
    EXPECT_TRUE(Contains(ErrorOfOpening(folder.path(), Description()), "writes to this data set"));
    CommitNow(first, 0, SmallClip(Sequence(), 0), {});
  }
  EXPECT_EQ(ErrorOfOpening(folder.path(), Description()), "");
}

TEST(DatasetWriter, SeveralThreads) {
  for (const Layout& layout : {Sequence(), Pairs()}) {
    const TempFolder alone, together;
    DatasetWriter one(alone.path(), layout, Description()), several(together.path(), layout, Description());
    for (int64_t clip = 0; clip < 16; ++clip) CommitNow(one, clip, SmallClip(layout, clip), {});
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        for (int64_t clip = t; clip < 16; clip += 4) CommitNow(several, clip, SmallClip(layout, clip), {});
      });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(several.done().size(), 16u);
    auto a = Tree(alone.path()), b = Tree(together.path());
    EXPECT_EQ(Manifest(together / "manifest.jsonl").done().size(), 16u);
    a.erase("manifest.jsonl"), b.erase("manifest.jsonl");  // its lines come in any order
    EXPECT_EQ(a, b);
  }
}

TEST(DatasetWriter, PlacesThatAreNotTheClips) {
  const TempFolder folder;
  DatasetWriter writer(folder.path(), Sequence(), Description());
  for (const std::string path :
       {"", "/tmp/x", "../x", "clips/000001/../../x", "clips/000002/turb/0.png", "dataset.json"}) {
    const std::vector<ClipFile> files = {{path, {1}, ""}};
    EXPECT_THROW(CommitNow(writer, 1, files, {}), std::invalid_argument) << path;
  }
  EXPECT_THROW(CommitNow(writer, -1, {}, {}), std::invalid_argument);
  EXPECT_TRUE(writer.done().empty());
}

}  // namespace
}  // namespace shimmer::dataset
