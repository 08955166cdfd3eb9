// A clip's bytes are a function of (config, clip index): on any number of threads, alone or in a run, stopped
// and gone on or not.
#include <sys/stat.h>

#include "tests/app/program.h"

namespace shimmer::app {
namespace {

// Everything that is drawn for a clip, from pictures of two sizes and numbers of channels.
std::string DrawnConfig(const std::string& layout) {
  return SmallConfig({{"clips", 6},
                      {"size", {{"choice", {{24, 16}, {17, 31}}}}},
                      {"source", {{"images", "in"}, {"scale", {{"uniform", {0.6, 1.7}}}}, {"flip", true}}},
                      {"tilt", {{"strength_px", {{"uniform", {1, 6}}}}}},
                      {"blur", {{"max_sigma_px", {{"uniform", {0.5, 2}}}}}},
                      {"camera", {{"shake", "walk"}, {"bound_px", 3}}},
                      {"objects",
                       {{{"drawn", "walker"}, {"height_px", 12}, {"shutter", 0.5}, {"distance", 0.5}},
                        {{"drawn", "disc"}, {"chance", 0.5}, {"height_px", {{"uniform", {3, 9}}}}}}},
                      {"sensor", {{"full_well", 3000}, {"compression", {{"choice", {"none", "jpeg"}}}}}},
                      {"colour", "linear"},
                      {"output",
                       {{"layout", layout},
                        {"truth", {"tilt", "sigma", "mask"}},
                        {"test_fraction", 0.3},
                        {"any_length", true},
                        {"tar_mb", 1}}}});
}

void PutPictures(const TempFolder& folder) {
  WritePng(folder, "in/colour.png", dataset::RandomImage({61, 67}, 3, 1));
  WritePng(folder, "in/grey.png", dataset::RandomImage({80, 53}, 1, 2), 16);
}

class Layouts : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Program, Layouts,
                         testing::Values("sequence", "pairs", "restormer", "basicsr", "webdataset"),
                         [](const auto& info) { return info.param; });

TEST_P(Layouts, AnyNumberOfThreadsGivesTheSameFiles) {
  const TempFolder folder;
  PutPictures(folder);
  folder.Put("c.json", DrawnConfig(GetParam()));
  for (const char* threads : {"1", "2", "5"})
    ExpectDone(Generate(folder, "c.json", std::string("set") + threads, {"--threads", threads}));
  const auto one = Tree(folder / "set1");
  // turb, clean and truth of each clip, or a tar of them
  EXPECT_GE(one.size(), GetParam() == "webdataset" ? 1u + 4u : 6u * 3u + 3u);
  EXPECT_EQ(Tree(folder / "set2"), one);
  EXPECT_EQ(Tree(folder / "set5"), one);
}

// Seed 0 is one that draws: clips differ from each other, and from those of seed 1.
TEST(Program, SeedZeroIsASeed) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  for (const char* seed : {"0", "1"})
    ExpectDone(Generate(folder, "c.json", std::string("set") + seed, {"--set", std::string("seed=") + seed}));
  std::set<std::string> frames;
  for (const char* set : {"set0", "set1"})
    for (const auto& [path, content] : Tree(folder / set))
      if (dataset::Contains(path, "turb/0000")) frames.insert(content);
  EXPECT_EQ(frames.size(), 8u);
}

TEST_P(Layouts, AClipAloneIsThatOfTheRun) {
  const TempFolder folder;
  PutPictures(folder);
  folder.Put("c.json", DrawnConfig(GetParam()));
  ExpectDone(Generate(folder, "c.json", "all"));
  ExpectDone(Generate(folder, "c.json", "alone", {"--clip", "3"}));
  const auto all = ManifestLines(folder / "all"), alone = ManifestLines(folder / "alone");
  if (GetParam() != "webdataset") {  // there it comes with its whole tar
    ASSERT_EQ(alone.size(), 1u);
  }
  const auto found = std::ranges::find(alone, 3, [](const Json& line) { return line.at("clip").get<int>(); });
  ASSERT_TRUE(found != alone.end());
  EXPECT_EQ(*found, all.at(3));
  for (const auto& [path, content] : Tree(folder / "alone")) {
    // What names all clips differs, of course.
    if (path == "manifest.jsonl" || path.ends_with("meta_info.txt") || path.ends_with(".yml") ||
        path == "report.html" || path == "shards/index.json")
      continue;
    EXPECT_EQ(content, Tree(folder / "all").at(path)) << path;
  }
  // The rest later gives the same set; the order of the manifest's lines is that in which they were made.
  ExpectDone(Generate(folder, "c.json", "alone"));
  auto later = Tree(folder / "alone"), run = Tree(folder / "all");
  later.erase("manifest.jsonl"), run.erase("manifest.jsonl");
  EXPECT_EQ(later, run);
}

// A clip that is asked for twice is made once, and another time not again.
TEST(Program, MakesEachWantedClipOnce) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  const Words wanted = {"--clip", "3", "--clip", "1", "--clip", "3"};
  ExpectDone(Generate(folder, "c.json", "set", wanted));
  ExpectDone(Generate(folder, "c.json", "set", wanted));
  EXPECT_EQ(ManifestLines(folder / "set").size(), 2u);
  EXPECT_EQ(dataset::DatasetReader(folder / "set").clips(), (std::set<int64_t>{1, 3}));
}

// `clips` may grow, and shrink: what is there stays.
TEST(Program, GoesOnWhereClipsGrew) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  ExpectDone(Generate(folder, "c.json", "whole"));
  for (const char* clips : {"clips=2", "clips=4"})
    ExpectDone(Generate(folder, "c.json", "set", {"--set", clips}));
  EXPECT_EQ(Tree(folder / "set"), Tree(folder / "whole"));
  const Ran fewer = Shimmer(folder, {"generate", "c.json", "--out", "set", "--set", "clips=2"});
  EXPECT_EQ(fewer.exit_code, 0);
  EXPECT_THAT(fewer.out, testing::HasSubstr("2 of 2 clips done, 0 failed"));
}

ino_t InodeOf(const fs::path& path) {
  struct stat status = {};
  return stat(path.c_str(), &status) == 0 ? status.st_ino : 0;
}

size_t LinesNow(const fs::path& manifest) {
  std::ifstream file(manifest);
  return static_cast<size_t>(std::count(std::istreambuf_iterator<char>(file), {}, '\n'));
}

class Stops : public testing::TestWithParam<std::tuple<std::string, int>> {};
INSTANTIATE_TEST_SUITE_P(Program, Stops,
                         testing::Combine(testing::Values("sequence", "pairs", "webdataset"),
                                          testing::Values(SIGINT, SIGTERM, SIGKILL)),
                         [](const auto& info) {
                           return std::get<0>(info.param) + "_" + std::to_string(std::get<1>(info.param));
                         });

// Stopped three times and run again, it is the set that was never stopped, down to the order of its manifest,
// with no file too many; and what was done is not done again.
TEST_P(Stops, AndGoesOn) {
  const auto [layout, signal] = GetParam();
  const TempFolder folder;
  folder.Put("c.json",
             SmallConfig({{"clips", 150},  // slow ones, so that a run can be caught at work
                          {"frames", 3},
                          {"size", {80, 64}},
                          {"blur", {{"max_sigma_px", 6}, {"method", "exact"}}},
                          {"output", {{"layout", layout}, {"frames_per_clip", 3}, {"tar_mb", 1}}}}));
  ExpectDone(Generate(folder, "c.json", "whole"));

  const Words command = {"generate", "c.json", "--out", "set", "--quiet", "--threads", "4"};
  const fs::path set = folder / "set";
  int stopped = 0;
  ino_t first_file = 0;
  for (const size_t clips : {1, 6, 13}) {
    // At work for sure, and listening: it has made one more
    const size_t lines =
        std::max(clips, fs::exists(set / "manifest.jsonl") ? LinesNow(set / "manifest.jsonl") + 1 : 1);
    Running running(folder.path(), command);
    WaitUntil([&] { return LinesNow(set / "manifest.jsonl") >= lines; });
    running.Signal(signal);
    const Ran ran = running.Wait();
    EXPECT_TRUE(ran.exit_code == 0 || ran.exit_code == (signal == SIGKILL ? 128 + SIGKILL : 130)) << ran.err;
    EXPECT_EQ(ran.err, "");
    stopped += ran.exit_code != 0;
    const dataset::DatasetReader reader(set);  // a set at any time
    ASSERT_TRUE(reader.clips().contains(0));
    const ino_t inode = InodeOf(set / reader.Files(0).turb[0].path);
    EXPECT_TRUE(first_file == 0 || first_file == inode);
    first_file = inode;
  }
  EXPECT_GT(stopped, 0);  // or else nothing was tested
  ExpectDone(Shimmer(folder, command));
  EXPECT_EQ(Tree(set), Tree(folder / "whole"));
  EXPECT_EQ(NamesIn(set), NamesIn(folder / "whole"));
  EXPECT_FALSE(fs::exists(set / ".staging"));
}

}  // namespace
}  // namespace shimmer::app
