// Fault 12: names that nobody expects, and a data set's folder that leads elsewhere.
#include <sys/stat.h>

#include "tests/app/sets.h"
#include "tests/app/small_disk.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

// "é" and so on, up to what a file system takes.
std::string LongName(const std::string& extension) {
  std::string name;
  while (name.size() + 2 + extension.size() <= 255) name += "\xc3\xa9";
  return name + extension;
}

TEST(Paths, OfSourcesMayBeAnyThatAFileMayHave) {
  const TempFolder folder;
  const Words names = {"two\nlines.png", "-dash.png",       LongName(".png"), "Twin.png",
                       "twin.png",       "\x1b[31mred.png", "\"quoted\".png", " .png"};
  for (size_t i = 0; i < names.size(); ++i) {
    WritePng(folder, "good/" + names[i], dataset::RandomImage({40, 30}, 3, static_cast<uint32_t>(i)));
    folder.Put("bad/" + names[i], "no picture");
  }
  folder.Put("-c.json", SmallConfig({{"clips", 60}, {"source", {{"images", "good"}}}}));
  ExpectDone(Generate(folder, "./-c.json", "set"));
  std::set<std::string> seen;
  for (const Json& line : ManifestLines(folder / "set")) seen.insert(line.at("source").at("path"));
  EXPECT_EQ(seen.size(), names.size());
  // Whatever is in a name, its error is one line.
  folder.Put("b.json", SmallConfig({{"clips", 60}, {"source", {{"images", "bad"}}}}));
  ExpectOneLine(Generate(folder, "b.json", "bad_set"), 1, {"60 clips failed"});
  for (const char* name : {"two\nlines.png", "\x1b[31mred.png"}) {
    folder.Put("b.json", SmallConfig({{"clips", 1}, {"source", {{"images", std::string("bad/") + name}}}}));
    const Ran ran = Generate(folder, "b.json", std::string("bad_") + name[0]);
    ExpectOneLine(ran, 1, {"1 clips failed"});
    EXPECT_EQ(ran.err.find('\x1b'), std::string::npos);
  }
}

TEST(Paths, OfTheSetMayLeadAnywhere) {
  const TempFolder folder;
  folder.Put("below/c.json", SmallConfig());
  fs::create_directories(folder / "real");
  fs::create_directory_symlink("real", folder / "link");
  const fs::path below = folder / "below";
  for (const std::string& out : {std::string("../up"), std::string("./a/../b"), std::string("../link"),
                                 LongName(""), std::string("two\nlines"), std::string("--out=-dash")}) {
    Words words = {"generate", "c.json", "--quiet"};
    if (out.starts_with("--"))
      words.push_back(out);
    else
      words.insert(words.end(), {"--out", out});
    ExpectDone(Shimmer(below, words));
  }
  for (const char* set : {"up", "below/b", "real", "below/two\nlines", "below/-dash"})
    EXPECT_EQ(dataset::DatasetReader(folder / set).clips().size(), 4u) << set;
  // What can't be made is one line.
  fs::create_symlink("nowhere", folder / "dangling");
  mkfifo((folder / "pipe").c_str(), 0666);
  const std::string too_long(256, 'x');
  ExpectOneLine(Generate(folder, "below/c.json", "dangling"), 1, {"dangling"});
  ExpectOneLine(Generate(folder, "below/c.json", "pipe"), 2, {"pipe: is a file, must be a folder"});
  ExpectOneLine(Generate(folder, "below/c.json", too_long), 1, {too_long});
  EXPECT_FALSE(fs::exists(folder / "nowhere"));
}

// In place of one of a set's own entries a link to what is outside, or a pipe.
class Elsewhere : public testing::TestWithParam<std::string> {
 protected:
  // A set of two clips of five.
  void SetUp() override {
    folder_.Put("c.json", SetConfig(GetParam(), 5));
    ExpectDone(Shimmer(folder_, GenerateWords("c.json", "set", {"--clip", "0", "--clip", "2"})));
    folder_.Put("outside/mine.txt", "mine");
  }
  // Entries that are used on the way to each file.
  std::set<std::string> Entries() const {
    std::set<std::string> entries = {".lock", ".sources", "manifest.jsonl", "dataset.json", ".staging"};
    for (const auto& [path, hash] : WholeTree(folder_ / "set"))
      for (fs::path above = fs::path(path).parent_path(); !above.empty(); above = above.parent_path())
        entries.insert(above);
    return entries;
  }
  void Run(const std::string& entry) {
    Running run(folder_.path(), GenerateWords("c.json", "set"));
    bool ended = false;
    std::jthread watch([&](std::stop_token stop) {
      for (int i = 0; i < 3000 && !stop.stop_requested(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      if (!stop.stop_requested()) run.Signal(SIGKILL);
    });
    const Ran ran = run.Wait();
    ended = true;
    watch.request_stop();
    EXPECT_TRUE(ended);
    EXPECT_TRUE(ran.exit_code >= 0 && ran.exit_code <= 2) << entry << ": " << ran.exit_code;
    if (ran.exit_code != 0) ExpectOneLine(ran, ran.exit_code, {"set"});
    EXPECT_EQ(Differing(outside_, WholeTree(folder_ / "outside")), Words()) << entry;
  }

  TempFolder folder_;
  std::map<std::string, std::string> outside_;
};
INSTANTIATE_TEST_SUITE_P(Layouts, Elsewhere, testing::ValuesIn(kLayouts),
                         [](const auto& info) { return info.param; });

TEST_P(Elsewhere, NothingIsMadeOrRemoved) {
  for (const std::string& entry : Entries()) {
    const fs::path place = folder_ / ("set/" + entry), kept = folder_ / "kept";
    const bool was_there = fs::exists(place);
    if (was_there) {
      fs::copy(place, folder_ / "outside/target", fs::copy_options::recursive);
      fs::rename(place, kept);
    } else {
      fs::create_directory(folder_ / "outside/target");
    }
    outside_ = WholeTree(folder_ / "outside");
    fs::create_symlink(folder_ / "outside/target", place);
    // As if killed in the middle of a clip's move.
    folder_.Put("set/.staging_test", "");
    fs::remove(folder_ / "set/.staging_test");
    Run(entry);
    fs::remove_all(place);
    mkfifo(place.c_str(), 0666);
    Run(entry + " as a pipe");
    fs::remove_all(place);
    if (was_there) fs::rename(kept, place);
    fs::remove_all(folder_ / "outside/target");
  }
  ExpectDone(Shimmer(folder_, GenerateWords("c.json", "set")));
  EXPECT_EQ(BrokenFiles(folder_ / "set"), Words());
}

// Part of a set on a file system of its own: files can't be moved there at once, and are not.
TEST(Paths, ThatLeadToAnotherDeviceAreRefused) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  ExpectDone(Generate(folder, "c.json", "set", {"--clip", "0"}));
  const auto before = Tree(folder / "set");
  fs::rename(folder / "set/clips", folder / "clips");
  {
    SmallDisk disk(folder / "set/clips", "size=1m");
    if (!disk.mounted()) GTEST_SKIP() << "no right to mount a file system";
    ExpectOneLine(Generate(folder, "c.json", "set"), 1, {"set/clips", "cross-device"});
  }
  fs::remove(folder / "set/clips");
  fs::rename(folder / "clips", folder / "set/clips");
  EXPECT_EQ(Tree(folder / "set"), before);
  ExpectDone(Generate(folder, "c.json", "set"));
}

}  // namespace
}  // namespace shimmer::app
