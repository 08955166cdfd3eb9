// Fault 7: the smallest and the largest frames, and any number of channels.
#include <cmath>

#include "tests/app/sets.h"
#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

// One clip of this size in each format; the frames have it, and are finite.
void ExpectSize(int width, int height) {
  for (const char* format : {"png", "exr"}) {
    const TempFolder folder;
    folder.Put("c.json", SmallConfig({{"clips", 1},
                                      {"size", {width, height}},
                                      {"output", {{"format", format}, {"truth", {"tilt", "sigma"}}}}}));
    ExpectDone(Shimmer(folder, GenerateWords("c.json", "set")));
    const dataset::DatasetReader set(folder / "set");
    for (const cv::Mat& frame :
         {set.Turb(0, 1).pixels, set.Clean(0, 1).pixels, set.TruthTilt(0, 1).value()}) {
      EXPECT_EQ(frame.size(), cv::Size(width, height));
      EXPECT_TRUE(cv::checkRange(frame));
    }
  }
}

TEST(Sizes, OfOnePixelAndOfOneRow) {
  ExpectSize(1, 1);
  for (int pixels = 2; pixels <= Times(5, 17); ++pixels) {
    ExpectSize(1, pixels);
    ExpectSize(pixels, 1);
  }
}

TEST(Sizes, OfLongRowsAndColumns) {
  const int longest = 16384;
  ExpectSize(longest, 1);
  ExpectSize(1, longest);
  if (!InSoak()) return;
  ExpectSize(32768, 1);
  ExpectSize(1, 32768);
}

TEST(Sizes, ThatAreTooLargeAreRefused) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  for (const char* size : {"size=[32769,1]", "size=[1,32769]", "size=[0,1]", "size=[1e9,1e9]"})
    ExpectOneLine(Generate(folder, "c.json", "set", {"--set", size}), 2, {"/size"});
  EXPECT_FALSE(fs::exists(folder / "set"));
}

// A source of each number of channels: what makes no picture is a failed clip, and the rest goes on.
TEST(Sizes, OfSourcesInChannels) {
  const TempFolder folder;
  const auto put = [&](const std::string& name, int channels, OIIO::TypeDesc type) {
    PutWithOiio(folder, "in/" + name,
                dataset::RandomImage({40, 30}, channels, static_cast<uint32_t>(channels)), type);
  };
  for (int channels = 1; channels <= 5; ++channels) {
    const std::string name = std::to_string(channels);
    if (channels <= 4) put(name + ".png", channels, OIIO::TypeUInt8);
    put(name + ".exr", channels, OIIO::TypeFloat);
    put(name + ".tif", channels, OIIO::TypeUInt16);
  }
  folder.Put("c.json", SmallConfig({{"clips", 150}, {"frames", 1}, {"source", {{"images", "in"}}}}));
  Shimmer(folder, GenerateWords("c.json", "set"));
  const dataset::DatasetReader set(folder / "set");
  std::set<std::string> done, failed;
  for (const int64_t clip : set.clips()) {
    const Json line = set.Line(clip);
    const auto path = line.at("source").at("path").get<std::string>();
    done.insert(path);
    EXPECT_EQ(line.at("channels"), path[3] == '1' || path == "in/2.png" ? 1 : 3) << path;
  }
  for (const int64_t clip : set.failed()) {
    const Json line = set.Line(clip);
    failed.insert(line.at("source").at("path"));
    EXPECT_THAT(line.at("error").get<std::string>(), testing::HasSubstr("channels"));
  }
  EXPECT_EQ(done.size() + failed.size(), 14u);  // each was drawn
  EXPECT_EQ(failed, (std::set<std::string>{"in/2.exr", "in/2.tif"}));
}

// The largest that there is any use for, within what --memory says.
TEST(SoakSizes, OfHugeFramesStayWithinMemory) {
  struct Huge {
    int side_px;
    const char* memory;
    int64_t most_bytes;
  };
  for (const auto [side_px, memory, most_bytes] :
       {Huge{2048, "1G", int64_t{1} << 30}, Huge{4096, "3G", int64_t{3} << 30},
        Huge{8192, "9G", int64_t{9} << 30}}) {
    const TempFolder folder;
    folder.Put("c.json", SmallConfig({{"clips", 2}, {"frames", 1}, {"size", {side_px, side_px}}}));
    const Ran ran = Generate(folder, "c.json", "set", {"--memory", memory});
    ExpectDone(ran);
    EXPECT_LE(ran.peak_bytes, most_bytes) << side_px;
    EXPECT_EQ(dataset::DatasetReader(folder / "set").Turb(1, 0).pixels.size(), cv::Size(side_px, side_px));
    Tell("7 sizes, " + std::to_string(side_px) + " x " + std::to_string(side_px) + " px with --memory " +
         memory + ": " + std::to_string(ran.peak_bytes >> 20) + " MiB at the most");
  }
}

}  // namespace
}  // namespace shimmer::app
