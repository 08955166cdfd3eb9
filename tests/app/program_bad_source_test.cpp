// Bad sources among good ones: their clips are noted as failed, with the file and the reason, and the rest
// finish.
#include <sys/stat.h>

#include <limits>

#include "tests/app/program.h"

namespace shimmer::app {
namespace {

// The first part of a file, as a download that broke off leaves it.
std::vector<uint8_t> CutOff(std::vector<uint8_t> bytes) {
  bytes.resize(bytes.size() * 6 / 10);
  return bytes;
}

// Pictures of 40 x 30, of which each bad one is bad in its own way. What its error says, by its name.
std::map<std::string, std::string> PutGoodAndBad(const TempFolder& folder) {
  const cv::Mat picture = dataset::RandomImage({40, 30}, 3, 1);
  folder.Put("in/good.png", dataset::EncodePng(picture, 8));
  folder.Put("in/good.exr", dataset::EncodeExr(picture, 16, Words{"R", "G", "B"}));
  folder.Put("in/empty.png", "");
  folder.Put("in/cut.png", CutOff(dataset::EncodePng(picture, 8)));
  folder.Put("in/cut.exr", CutOff(dataset::EncodeExr(picture, 32, Words{"R", "G", "B"})));
  folder.Put("in/text.png", "not a picture");
  folder.Put("in/text.jpg", "not a picture");
  PutWithOiio(folder, "in/good.jpg", picture, OIIO::TypeUInt8);
  folder.Put("in/cut.jpg", CutOff(dataset::ReadFile(folder / "in/good.jpg")));
  folder.Put("in/small.png", dataset::EncodePng(picture(cv::Rect(0, 0, 23, 30)), 8));
  fs::create_symlink("nowhere", folder / "in/dangling.png");
  mkfifo((folder / "in/pipe.png").c_str(), 0666);  // which must not be waited for
  return {{"empty.png", "empty (0 bytes)"},
          {"cut.png", "damaged picture"},
          {"cut.exr", "damaged picture"},
          {"cut.jpg", "damaged picture"},
          {"text.png", "not a picture"},
          {"text.jpg", "not a picture"},
          {"small.png", "is 23x30 px, smaller than the crop of 24x16"},
          {"dangling.png", "no such file"},
          {"pipe.png", "not a regular file"}};
}

TEST(BadSources, AreNotedAndTheRestFinish) {
  const TempFolder folder;
  const auto bad = PutGoodAndBad(folder);
  folder.Put("c.json", SmallConfig({{"clips", 80}, {"frames", 1}, {"source", {{"images", "in/*"}}}}));
  const Ran ran = Generate(folder, "c.json", "set");
  ExpectOneLine(ran, 1, {"set/manifest.jsonl: ", " clips failed"});

  std::set<std::string> seen;
  size_t done = 0;
  for (const Json& line : ManifestLines(folder / "set")) {
    if (line.at("status") == "done") {
      const auto path = line.at("source").at("path").get<std::string>();
      EXPECT_TRUE(path.starts_with("in/good.")) << path;
      ++done;
      continue;
    }
    EXPECT_EQ(line.at("status"), "failed");
    EXPECT_FALSE(line.contains("files"));
    const auto error = line.at("error").get<std::string>();
    const std::string name = error.substr(3, error.find(':') - 3);  // after "in/"
    ASSERT_TRUE(bad.contains(name)) << error;
    EXPECT_THAT(error, testing::HasSubstr(bad.at(name)));
    EXPECT_EQ(error.find('\n'), std::string::npos);
    seen.insert(name);
  }
  EXPECT_EQ(seen.size(), bad.size());
  EXPECT_GT(done, 5u);
  EXPECT_EQ(dataset::DatasetReader(folder / "set").clips().size(), done);

  // Again: still failed, and nothing is done over.
  const auto before = Tree(folder / "set");
  ExpectOneLine(Generate(folder, "c.json", "set"), 1, {" clips failed"});
  EXPECT_EQ(Tree(folder / "set"), before);
  // One that is asked for by its number is tried once more.
  const auto failed = dataset::DatasetReader(folder / "set").failed();
  const size_t lines = ManifestLines(folder / "set").size();
  ExpectOneLine(Generate(folder, "c.json", "set", {"--clip", std::to_string(*failed.begin())}), 1,
                {" clips failed"});
  EXPECT_EQ(ManifestLines(folder / "set").size(), lines + 1);
  EXPECT_EQ(dataset::DatasetReader(folder / "set").failed(), failed);
}

TEST(BadSources, UnreadableFile) {
  const TempFolder folder;
  WritePng(folder, "in.png", dataset::RandomImage({40, 30}, 3, 1));
  fs::permissions(folder / "in.png", fs::perms::none);
  fs::permissions(folder.path(), fs::perms::all);
  folder.Put("c.json", SmallConfig({{"clips", 1}, {"source", {{"images", "in.png"}}}}));
  const bool root = geteuid() == 0;  // who reads everything
  for (int run = 0; run < 2; ++run) {
    const Ran ran = Running(folder.path(), {"generate", "c.json", "--out", "set", "--quiet"}, root).Wait();
    if (ran.exit_code == kNotStarted) GTEST_SKIP() << "nobody may not run " << SHIMMER_PROGRAM;
    ExpectOneLine(ran, 1, {"1 clips failed"});
  }
  EXPECT_THAT(ManifestLines(folder / "set").at(0).at("error").get<std::string>(),
              testing::AllOf(testing::StartsWith("in.png: "), testing::HasSubstr("Permission denied")));
}

// A name that is no UTF-8 can be in a folder, though not in JSON.
TEST(BadSources, NameThatIsNoUtf8IsNoFault) {
  const TempFolder folder;
  WritePng(folder, "in/caf\xe9.png", dataset::RandomImage({40, 30}, 3, 1));
  folder.Put("c.json", SmallConfig({{"source", {{"images", "in"}}}}));
  for (int run = 0; run < 2; ++run) ExpectDone(Generate(folder, "c.json", "set"));
}

// Output is finite, and the manifest counts what was replaced.
TEST(BadSources, ExrWithNanAndInf) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const TempFolder folder;
  cv::Mat picture = dataset::RandomImage({24, 16}, 3, 1);
  picture.at<cv::Vec3f>(10, 12) = {std::nanf(""), kInf, -kInf};
  picture.at<cv::Vec3f>(11, 13)[0] = kInf;
  PutWithOiio(folder, "in/a.exr", picture, OIIO::TypeFloat);
  PutWithOiio(folder, "in/b.exr", dataset::RandomImage({24, 16}, 3, 2), OIIO::TypeFloat);
  for (const char* source : {"images", "sequence"})
    for (const char* colour : {"stored", "linear"})
      for (const char* format : {"png", "exr"}) {
        const std::string set = std::string(source) + colour + format;
        folder.Put("c.json", SmallConfig({{"clips", 1},
                                          {"source", {{source, source[0] == 'i' ? "in/a.exr" : "in"}}},
                                          {"colour", colour},
                                          {"output", {{"format", format}, {"truth", {"tilt", "sigma"}}}}}));
        ExpectDone(Generate(folder, "c.json", set));
        const dataset::DatasetReader reader(folder / set);
        EXPECT_EQ(reader.Line(0).at("source").at("replaced_samples"), 4) << set;
        for (int64_t frame = 0; frame < 2; ++frame) {
          // Reading replaces too, so it must have found nothing.
          EXPECT_EQ(reader.Turb(0, frame).replaced + reader.Clean(0, frame).replaced, 0) << set;
          EXPECT_TRUE(cv::checkRange(reader.Turb(0, frame).pixels, true, nullptr, -70000, 70000)) << set;
          EXPECT_TRUE(cv::checkRange(reader.TruthTilt(0, frame).value())) << set;
        }
      }
}

TEST(BadSources, OnePixelIsEnoughForAClipOfOnePixel) {
  const TempFolder folder;
  WritePng(folder, "in.png", dataset::RandomImage({1, 1}, 3, 1));
  folder.Put("c.json", SmallConfig({{"size", {1, 1}}, {"source", {{"images", "in.png"}}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  const dataset::DatasetReader reader(folder / "set");
  ASSERT_EQ(reader.clips().size(), 4u);
  // Its reflection is all there is to see: whatever moves, the pixel stays what it was.
  for (const int64_t clip : reader.clips())
    EXPECT_EQ(cv::norm(reader.Turb(clip, 1).pixels, reader.Clean(clip, 1).pixels, cv::NORM_INF), 0);
}

// A scale by which no crop fits is undone as far as it must be; a source that is too small itself fails.
TEST(BadSources, SmallerThanTheCrop) {
  const TempFolder folder;
  WritePng(folder, "in.png", dataset::RandomImage({30, 20}, 3, 1));
  folder.Put("c.json", SmallConfig({{"clips", 1}, {"source", {{"images", "in.png"}, {"scale", 0.1}}}}));
  ExpectDone(Generate(folder, "c.json", "fits"));
  EXPECT_EQ(ManifestLines(folder / "fits").at(0).at("source").at("scale"), 0.8);  // 24 of 30, 16 of 20
  ExpectOneLine(Generate(folder, "c.json", "not", {"--set", "size=[24,21]"}), 1, {"1 clips failed"});
  EXPECT_THAT(ManifestLines(folder / "not").at(0).at("error").get<std::string>(),
              testing::AllOf(testing::HasSubstr("in.png: is 30x20 px"),
                             testing::HasSubstr("smaller than the crop of 24x21")));
}

}  // namespace
}  // namespace shimmer::app
