// Layout pairs, as the paper authors' training reads it: by listing two folders, each in sorted order.
#include "tests/app/program.h"

namespace shimmer::app {
namespace {

TEST(Pairs, HaveEqualNamesAndNothingElse) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"clips", 10},
                                    {"frames", 7},
                                    {"output",
                                     {{"layout", "pairs"},
                                      {"name", "night"},
                                      {"test_fraction", 0.3},
                                      {"frames_per_clip", 3},
                                      {"truth", {"tilt", "sigma"}}}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  EXPECT_EQ(NamesIn(folder / "set"),
            (std::set<std::string>{".lock", "dataset.json", "manifest.jsonl", "night", "report.html"}));
  EXPECT_EQ(NamesIn(folder / "set/night"), (std::set<std::string>{"test", "train"}));
  std::set<std::string> all;
  for (const auto& [half, count] : {std::pair{"train", 21u}, std::pair{"test", 9u}}) {
    const fs::path path = folder / "set" / "night" / half;
    EXPECT_EQ(NamesIn(path), (std::set<std::string>{"noturb", "truth", "turb"}));
    const auto names = NamesIn(path / "turb");
    EXPECT_EQ(names.size(), count);
    EXPECT_EQ(NamesIn(path / "noturb"), names);
    for (const std::string& name : names) {
      EXPECT_TRUE(fs::exists(path / "truth" / fs::path(name).replace_extension("exr"))) << name;
      EXPECT_EQ(name.size(), std::string("000000.png").size());
    }
    EXPECT_EQ(NamesIn(path / "truth").size(), count);
    all.insert(names.begin(), names.end());
  }
  EXPECT_EQ(all.size(), 30u);
  EXPECT_EQ(*all.begin(), "000000.png");
  EXPECT_EQ(*all.rbegin(), "000029.png");
}

// The fraction is exact, whatever the number of clips, none and all included.
TEST(Pairs, SplitByTheExactFraction) {
  const TempFolder folder;
  folder.Put(
      "c.json",
      SmallConfig({{"clips", 25}, {"frames", 1}, {"size", {2, 2}}, {"output", {{"layout", "pairs"}}}}));
  for (const auto& [fraction, tests] :
       std::map<std::string, size_t>{{"0", 0}, {"0.04", 1}, {"0.2", 5}, {"1", 25}}) {
    ExpectDone(Generate(folder, "c.json", fraction, {"--set", "output.test_fraction=" + fraction}));
    const fs::path path = folder / fraction / "shimmer";
    EXPECT_EQ(fs::exists(path / "test") ? NamesIn(path / "test/turb").size() : 0, tests);
    EXPECT_EQ(fs::exists(path / "train") ? NamesIn(path / "train/turb").size() : 0, 25 - tests);
  }
}

// The frames that are kept are those of the sequence layout, evenly spread: 0, 2 and 4 of 7.
TEST(Pairs, KeepFramesOfTheClip) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"clips", 2}, {"frames", 7}, {"output", {{"frames_per_clip", 3}}}}));
  ExpectDone(Generate(folder, "c.json", "sequence"));
  ExpectDone(Generate(folder, "c.json", "pairs", {"--set", "output.layout=pairs"}));
  const dataset::DatasetReader sequence(folder / "sequence"), pairs(folder / "pairs");
  for (const int64_t clip : {0, 1})
    for (const int64_t k : {0, 1, 2}) {
      const cv::Mat turb = pairs.Turb(clip, k).pixels, clean = pairs.Clean(clip, k).pixels;
      EXPECT_EQ(cv::norm(turb, sequence.Turb(clip, 7 * k / 3).pixels, cv::NORM_INF), 0);
      EXPECT_EQ(cv::norm(clean, sequence.Clean(clip, 7 * k / 3).pixels, cv::NORM_INF), 0);
    }
}

}  // namespace
}  // namespace shimmer::app
