// What `shimmer preview` draws: sheets and animations of sets of every kind.
#include "tests/app/program.h"

namespace shimmer::app {
namespace {

TEST(Previews, OfAnySet) {
  const TempFolder folder;
  const Json truth = {{"truth", {"tilt", "sigma"}}}, tilt_only = {{"truth", {"tilt"}}};
  const std::map<std::string, Json> sets = {
      {"plain", Json::object()},
      {"truth", {{"output", truth}}},
      {"tilt", {{"output", tilt_only}}},
      {"pairs", {{"output", {{"layout", "pairs"}, {"frames_per_clip", 2}}}}},
      {"pairs_truth", {{"output", {{"layout", "pairs"}, {"truth", {"sigma", "tilt"}}}}}},
      {"linear_exr", {{"colour", "linear"}, {"output", {{"format", "exr"}}}}},
      {"one_pixel", {{"size", {1, 1}}}},
      {"line", {{"size", {1500, 1}}}},
      {"sizes", {{"size", {{"choice", {{9, 33}, {40, 20}}}}}}}};
  for (const auto& [name, changes] : sets) {
    folder.Put("c.json", SmallConfig(changes));
    ExpectDone(Generate(folder, "c.json", name));
    const auto before = Tree(folder / name);
    ExpectDone(Shimmer(folder, {"preview", name, "--out", name + ".png"}));
    ExpectDone(Shimmer(folder, {"preview", name, "--out", name + ".gif", "--clip", "2"}));
    EXPECT_EQ(dataset::ReadImage(folder / (name + ".png")).pixels.channels(), 3) << name;
    EXPECT_EQ(ReadText(folder / (name + ".gif")).substr(0, 6), "GIF89a") << name;
    EXPECT_EQ(Tree(folder / name), before) << name;
  }
  // Truth that was not written is computed: the same sheet.
  EXPECT_EQ(ReadText(folder / "plain.png"), ReadText(folder / "truth.png"));
  EXPECT_EQ(ReadText(folder / "plain.png"), ReadText(folder / "tilt.png"));
}

double MeanOf(const fs::path& picture) { return cv::mean(dataset::ReadImage(picture).pixels)[0]; }

// Linear light is shown as a screen wants it: as bright as the same scene from a PNG.
TEST(Previews, OfLinearLightAreNotDark) {
  const TempFolder folder;
  WritePng(folder, "in.png", cv::Mat(40, 40, CV_32FC3, cv::Scalar::all(0.5)));
  folder.Put("c.json", SmallConfig({{"clips", 1}, {"source", {{"images", "in.png"}}}, {"colour", "linear"}}));
  for (const std::string format : {"png", "exr"}) {
    ExpectDone(Generate(folder, "c.json", format, {"--set", "output.format=" + format}));
    ExpectDone(Shimmer(folder, {"preview", format, "--out", format + ".png"}));
  }
  EXPECT_NEAR(MeanOf(folder / "exr.png"), MeanOf(folder / "png.png"),
              2e-3);  // half's rounding, at most a level
}

TEST(Previews, RowsAreClips) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"clips", 5}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  const auto height = [&](const char* rows) {
    ExpectDone(Shimmer(folder, {"preview", "set", "--out", "sheet.png", "--rows", rows}));
    return dataset::ReadImage(folder / "sheet.png").pixels.rows;
  };
  const int one = height("1"), two = height("2"), five = height("5");
  EXPECT_EQ(five - two, 3 * (two - one));
  EXPECT_EQ(height("100"), five);
}

TEST(Previews, OfWhatIsNotThere) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  ExpectOneLine(Shimmer(folder, {"preview", "no", "--out", "sheet.png"}), 1, {"no: not a data set"});
  ExpectDone(Generate(folder, "c.json", "set", {"--clip", "2"}));
  ExpectOneLine(Shimmer(folder, {"preview", "set", "--out", "clip.gif", "--clip", "1"}), 2,
                {"clip 1 is not in this data set"});
  ExpectOneLine(Shimmer(folder, {"preview", "set", "--out", "no/sheet.png"}), 1, {"no/sheet.png"});
  ExpectOneLine(Shimmer(folder, {"preview", "set", "--out", "sheet"}), 2, {"must end in .png"});
  ExpectOneLine(Shimmer(folder, {"preview", "set", "--out", "sheet.png", "--rows", "0"}), 2, {"--rows"});

  fs::resize_file(folder / "set/clips/000002/turb/0001.png", 60);
  ExpectOneLine(Shimmer(folder, {"preview", "set", "--out", "clip.gif"}), 1, {"0001.png: damaged picture"});
  EXPECT_EQ(NamesIn(folder.path()), (std::set<std::string>{"c.json", "set"}));  // no half picture either

  // A set that another version made, with keys that this one doesn't know.
  Json description = Json::parse(ReadText(folder / "set/dataset.json"));
  description["config"]["camera"] = {{"shake_px", 2}};
  folder.Put("set/dataset.json", description.dump());
  ExpectOneLine(Shimmer(folder, {"preview", "set", "--out", "sheet.png"}), 1,
                {"set/dataset.json:/config/camera"});
}

}  // namespace
}  // namespace shimmer::app
