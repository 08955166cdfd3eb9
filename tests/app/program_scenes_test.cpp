// Scenes that move, as the program makes them and the reader gives them back.
#include <opencv2/imgproc.hpp>

#include "tests/app/sets.h"

namespace shimmer::app {
namespace {

using testing::HasSubstr;

// A disc that goes 3 px a frame to the right, before stripes; whole px of shake.
Json MovingParts() {
  return {{"frames", 3},
          {"size", {64, 48}},
          {"tilt", {{"strength_px", 2}}},
          {"camera", {{"shake", "list"}, {"shifts", {{0, 0}, {-4, 3}, {2, 5}}}}},
          {"objects",
           {{{"drawn", "disc"},
             {"height_px", 20},
             {"motion", {{"start_x", 0.4}, {"start_y", 0.5}, {"speed_px", 3}}}}}}};
}

std::string MovingConfig(const std::string& layout, Json truth, const Json& more = Json::object()) {
  Json changes = MovingParts();
  changes.update(more);
  changes["output"] = {{"truth", std::move(truth)}, {"frames_per_clip", 3}};
  return SetConfig(layout, 2, changes);
}

void ExpectTruthOfTheDisc(const dataset::DatasetReader& reader, bool single_frames) {
  const std::vector<cv::Point2d> shifts = {{0, 0}, {-4, 3}, {2, 5}};
  for (const int64_t clip : reader.clips()) {
    if (!single_frames) {
      EXPECT_EQ(reader.TruthShake(clip).value(), shifts);
    }
    for (int64_t k = 0; k < 3; ++k) {
      const cv::Mat mask = reader.TruthMask(clip, k).value();
      const cv::Moments moments = cv::moments(mask);
      EXPECT_NEAR(moments.m00, M_PI * 100, 0.03 * 2 * M_PI * 10);
      EXPECT_NEAR(moments.m10 / moments.m00, 0.4 * 64 - 0.5 + 3.0 * static_cast<double>(k), 0.02);
      EXPECT_NEAR(moments.m01 / moments.m00, 23.5, 0.02);
      const auto flow = reader.TruthFlow(clip, k);
      EXPECT_EQ(flow.has_value(), !single_frames && k < 2);
      if (!flow) continue;
      EXPECT_EQ(flow->at<cv::Vec2f>(2, 2), cv::Vec2f(0, 0));
      EXPECT_LT(cv::norm(flow->at<cv::Vec2f>(24, 25) - cv::Vec2f(3, 0)), 1e-4);
    }
    EXPECT_EQ(reader.Line(clip).at("plan").at("objects"), 1);
    EXPECT_NEAR(reader.Line(clip).at("moving_share").get<double>(), M_PI * 100 / (64 * 48), 0.002);
  }
}

bool IsOfScenes(const std::string& name) {
  return dataset::Contains(name, "mask") || dataset::Contains(name, "shake.json");
}

// Zeros in the place of a tar's member.
void Blank(const fs::path& tar, const dataset::StoredFile& member) {
  std::fstream file(tar, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(member.offset));
  const std::string zeros(static_cast<size_t>(member.bytes), '\0');
  file.write(zeros.data(), static_cast<std::streamsize>(zeros.size()));
}

class Scenes : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Program, Scenes, testing::ValuesIn(kLayouts),
                         [](const auto& info) { return info.param; });

TEST_P(Scenes, TheirTruthIsReadBackAndVerified) {
  const bool single_frames = GetParam() == "pairs" || GetParam() == "restormer";
  const Json truth = single_frames ? Json{"mask"} : Json{"tilt", "mask", "flow", "shake"};
  const TempFolder folder;
  folder.Put("c.json", MovingConfig(GetParam(), truth));
  ExpectDone(Generate(folder, "c.json", "set"));
  ExpectTruthOfTheDisc(dataset::DatasetReader(folder / "set"), single_frames);
  EXPECT_EQ(Shimmer(folder, {"verify", "set", "--quiet"}).exit_code, 0);
  // What is taken away is missed, and made again as it was.
  const auto before = WholeTree(folder / "set");
  for (const auto& [path, content] : before)
    if (IsOfScenes(path)) fs::remove_all(folder / ("set/" + path));
  for (const dataset::StoredFile& file :
       dataset::FilesOfLine(dataset::Manifest(dataset::ManifestsIn(folder / "set")).Line(0)))
    if (!file.member.empty() && IsOfScenes(file.member)) Blank(folder / ("set/" + file.path), file);
  EXPECT_EQ(Shimmer(folder, {"verify", "set", "--quiet"}).exit_code, 1);
  EXPECT_EQ(Shimmer(folder, {"verify", "set", "--repair", "--quiet"}).exit_code, 0);
  const Words differing = Differing(before, WholeTree(folder / "set"));
  for (const std::string& name : differing) EXPECT_THAT(name, HasSubstr("manifest"));
}

cv::Mat CleanOf(const dataset::DatasetReader& reader, int64_t k) { return reader.Clean(0, k).pixels; }

// The clean twin stands, whatever the camera does; on request it shakes: steady(p) = shaken(p + s).
TEST(ProgramScenes, TheCleanTwinIsSteadyOrShaken) {
  const TempFolder folder;
  folder.Put("c.json", MovingConfig("sequence", {"shake"}));
  ExpectDone(Generate(folder, "c.json", "steady"));
  ExpectDone(Generate(folder, "c.json", "shaken", {"--set", "camera.shaken_clean=true"}));
  ExpectDone(Generate(folder, "c.json", "stands", {"--set", "camera.shake=none"}));
  const dataset::DatasetReader steady(folder / "steady"), shaken(folder / "shaken"),
      stands(folder / "stands");
  const std::vector<cv::Point> shifts = {{0, 0}, {-4, 3}, {2, 5}};
  for (int64_t k = 0; k < 3; ++k) {
    EXPECT_EQ(cv::norm(CleanOf(steady, k), CleanOf(stands, k), cv::NORM_INF), 0) << k;
    const cv::Rect inside({8, 8}, cv::Size(48, 32));
    EXPECT_EQ(cv::norm(CleanOf(steady, k)(inside),
                       CleanOf(shaken, k)(inside + shifts[static_cast<size_t>(k)]), cv::NORM_INF),
              0);
    EXPECT_EQ(cv::norm(steady.Turb(0, k).pixels, shaken.Turb(0, k).pixels, cv::NORM_INF), 0);
  }
  EXPECT_GT(cv::norm(CleanOf(shaken, 1), CleanOf(steady, 1), cv::NORM_INF), 0.1);
}

// Nothing that is off leaves a trace: the same pictures, byte by byte, as a config that does not speak of it.
TEST(ProgramScenes, WhatIsOffCostsNoBit) {
  const TempFolder folder;
  folder.Put("plain.json", SetConfig("sequence", 2));
  folder.Put("off.json", SetConfig("sequence", 2,
                                   {{"camera", {{"shake", "walk"}, {"amplitude_px", 0}}},
                                    {"objects", {{{"drawn", "disc"}, {"chance", 0}}}},
                                    {"sensor", {{"veil", 0}}}}));
  ExpectDone(Generate(folder, "plain.json", "plain"));
  ExpectDone(Generate(folder, "off.json", "off"));
  for (const std::string& name : Differing(WholeTree(folder / "plain"), WholeTree(folder / "off")))
    EXPECT_TRUE(name == "dataset.json" || name == "manifest.jsonl" || name == "report.html") << name;
}

// A cut-out of a file: its own alpha, at its place; without alpha it is refused.
TEST(ProgramScenes, CutoutsAndVideosWithMasksAreObjects) {
  const TempFolder folder;
  cv::Mat rgba(12, 10, CV_32FC4, cv::Scalar(1, 0, 0, 1));
  rgba.rowRange(0, 6).setTo(cv::Scalar(1, 0, 0, 0));  // its upper half is not there
  WritePng(folder, "cut/half.png", rgba);
  for (int k = 0; k < 4; ++k) {
    WritePng(folder, "film/" + std::to_string(k) + ".png", cv::Mat(12, 10, CV_32FC3, cv::Scalar(0, 1, 0)));
    cv::Mat mask = cv::Mat::zeros(12, 10, CV_32FC1);
    mask.rowRange(6, 12).setTo(1);
    WritePng(folder, "matte/" + std::to_string(k) + ".png", mask);
  }
  const Json still = {{"strength_px", 0}}, clear = {{"max_sigma_px", 0}};
  const Json motion = {{"start_x", 0.5}, {"start_y", 0.5}, {"speed_px", 0}};
  for (const auto& [look, colour] :
       {std::pair(Json{{"images", "cut"}, {"height_px", 12}, {"motion", motion}}, cv::Vec3f(1, 0, 0)),
        std::pair(Json{{"sequence", "film"}, {"masks", "matte"}, {"height_px", 12}, {"motion", motion}},
                  cv::Vec3f(0, 1, 0))}) {
    folder.Put(
        "c.json",
        SetConfig(
            "sequence", 1,
            {{"tilt", still}, {"blur", clear}, {"objects", {look}}, {"output", {{"truth", {"mask"}}}}}));
    fs::remove_all(folder / "set");
    ExpectDone(Generate(folder, "c.json", "set"));
    const dataset::DatasetReader reader(folder / "set");
    const cv::Mat mask = reader.TruthMask(0, 1).value(), turb = reader.Turb(0, 1).pixels;
    EXPECT_NEAR(cv::sum(mask)[0], 60, 4);  // 10 x 6; its edges lie between pixels
    EXPECT_LT(cv::norm(turb.at<cv::Vec3f>(11, 12) - colour), 0.02);
    EXPECT_EQ(mask.at<float>(4, 12), 0);
    EXPECT_TRUE(reader.description().at("sources").at(0).contains("object"));
  }
  WritePng(folder, "cut/half.png", cv::Mat(12, 10, CV_32FC3, cv::Scalar(0, 1, 0)));
  folder.Put("bad.json", SetConfig("sequence", 1, {{"objects", {{{"images", "cut"}}}}}));
  ExpectOneLine(Generate(folder, "bad.json", "bad"), 1, {"half.png: has no alpha"});
}

// A video's own masks, with objects over them.
TEST(ProgramScenes, MasksOfAVideoAreTruth) {
  const TempFolder folder;
  for (int k = 0; k < 3; ++k) {
    WritePng(folder, "film/" + std::to_string(k) + ".png",
             dataset::RandomImage({40, 30}, 3, static_cast<uint32_t>(k)));
    cv::Mat mask(30, 40, CV_32FC1, cv::Scalar(0.6));
    mask.colRange(0, 20).setTo(1);
    WritePng(folder, "masks/" + std::to_string(k) + ".png", mask);
  }
  const auto config = [](double threshold) {
    return SetConfig("sequence", 1,
                     {{"size", {40, 30}},
                      {"source", {{"sequence", "film"}, {"masks", "masks"}, {"mask_threshold", threshold}}},
                      {"output", {{"truth", {"mask"}}}}});
  };
  folder.Put("c.json", config(0.9));
  folder.Put("soft.json", config(0));
  ExpectDone(Generate(folder, "c.json", "set"));
  ExpectDone(Generate(folder, "soft.json", "soft"));
  const cv::Mat hard = dataset::DatasetReader(folder / "set").TruthMask(0, 1).value(),
                soft = dataset::DatasetReader(folder / "soft").TruthMask(0, 1).value();
  EXPECT_EQ(hard.at<float>(3, 19), 1);
  EXPECT_EQ(hard.at<float>(3, 20), 0);
  EXPECT_NEAR(soft.at<float>(3, 20), 0.6, 0.002);

  WritePng(folder, "masks/0.png", cv::Mat::zeros(30, 41, CV_32FC1));
  WritePng(folder, "masks/1.png", cv::Mat::zeros(30, 41, CV_32FC1));
  ExpectOneLine(Generate(folder, "c.json", "other", {"--set", "source.start=first"}), 1,
                {"source.masks: masks: frame 0 is 41x30 px, must be 40x30"});
  fs::remove(folder / "masks/2.png");
  ExpectOneLine(Generate(folder, "c.json", "fewer"), 1, {"/source/masks: ", "has 2 frames, must have 3"});
  folder.Put("flow.json", SetConfig("sequence", 1,
                                    {{"source", {{"sequence", "film"}}}, {"output", {{"truth", {"flow"}}}}}));
  ExpectOneLine(Generate(folder, "flow.json", "flow"), 2, {"flow.json:/output/truth/0: ", "not known"});
}

TEST(ProgramScenes, WhatCannotBeIsSaidWithItsField) {
  const TempFolder folder;
  WritePng(folder, "in/small.png", dataset::RandomImage({70, 70}, 3, 1));
  const auto expect = [&](const Json& changes, int exit_code, const Words& parts) {
    folder.Put("c.json", SetConfig("sequence", 1, changes));
    fs::remove_all(folder / "set");
    ExpectOneLine(Generate(folder, "c.json", "set"), exit_code, parts);
  };
  expect(
      {{"size", {64, 64}}, {"source", {{"images", "in"}}}, {"camera", {{"shake", "walk"}, {"bound_px", 10}}}},
      1, {"small.png: is 70x70 px", "64x64", "84x84", "camera.shake", "bound_px"});
  expect({{"camera", {{"shake", "list"}, {"shifts", {{0, 0}}}}}}, 2,
         {"c.json:/camera/shifts: has 1 shifts, must have"});
  expect({{"objects", {{{"drawn", "disc"}, {"motion", {{"start_x", 0.99}, {"speed_px", 9}}}}}}}, 2,
         {"c.json:/objects/0/motion: leaves the scene: in frame 1"});
  expect({{"objects",
           {{{"drawn", "disc"}, {"motion", {{"start_x", 0.99}, {"speed_px", {{"uniform", {8, 9}}}}}}}}}},
         1, {"objects.0.motion: leaves the scene: in frame 1"});
  expect({{"objects", {{{"drawn", "disc"}, {"motion", {{"path", "spline"}}}}}}}, 2,
         {"/objects/0/motion: points: has 0"});
  expect({{"objects", {{{"sequence", "in"}}}}}, 2, {"/objects/0/masks: is empty, must say"});
  expect({{"objects", {{{"drawn", "disc"}, {"masks", "in"}}}}}, 2, {"/objects/0/masks: has no meaning"});
  expect({{"objects", {{{"drawn", "text"}, {"text", " "}}}}}, 1, {"objects.0.text \" \": has nothing"});
  expect({{"objects", {{{"images", "nowhere"}}}}}, 2, {"/objects/0/images: ", "nowhere"});
}

TEST(ProgramScenes, ALabelIsNoValue) {
  const TempFolder folder;
  folder.Put("c.json", SetConfig("sequence", 1,
                                 {{"camera", {{"shake", {{"choice", {"none", "walk"}}, {"as", "list"}}}}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
}

// Compression changes turbulent frames alone, and is what its library makes of them.
TEST(ProgramScenes, CompressionIsOfTheTurbulentFrames) {
  const TempFolder folder;
  for (const int bits : {8, 16}) {
    folder.Put("c.json", SetConfig("sequence", 1, {{"size", {64, 48}}, {"output", {{"bits", bits}}}}));
    std::map<std::string, cv::Mat> turb, clean;
    for (const char* compression : {"none", "jpeg", "h264"}) {
      const std::string set = compression + std::to_string(bits);
      ExpectDone(
          Generate(folder, "c.json", set, {"--set", std::string("sensor.compression=") + compression}));
      const dataset::DatasetReader reader(folder / set);
      turb[compression] = reader.Turb(0, 1).pixels, clean[compression] = reader.Clean(0, 1).pixels;
    }
    for (const char* compression : {"jpeg", "h264"}) {
      EXPECT_EQ(cv::norm(clean[compression], clean["none"], cv::NORM_INF), 0);
      const double levels =
          255 * cv::norm(turb[compression], turb["none"], cv::NORM_L2) / std::sqrt(3.0 * 64 * 48);
      EXPECT_GT(levels, 0.3) << compression;
      EXPECT_LT(levels, 25) << compression;
    }
  }
  folder.Put("pairs.json", SetConfig("pairs", 1, {{"frames", 3}, {"sensor", {{"compression", "h264"}}}}));
  ExpectOneLine(Generate(folder, "pairs.json", "pairs"), 2, {"pairs.json:/sensor/compression: is h264"});
}

// What a file of half floats holds is what was simulated, also where an object was composed into it.
TEST(ProgramScenes, HalvesAreWhatWasSimulated) {
  const TempFolder folder;
  folder.Put("c.json", SetConfig("sequence", 1,
                                 {{"size", {64, 48}},
                                  {"tilt", {{"strength_px", 0}}},
                                  {"blur", {{"max_sigma_px", 0}}},
                                  {"objects", {{{"drawn", "walker"}, {"height_px", 30.3}}}},
                                  {"output", {{"format", "exr"}, {"bits", 16}}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  const dataset::DatasetReader reader(folder / "set");
  for (int64_t k = 0; k < 2; ++k)  // nothing is done to the clean frame: the turbulent one is its copy
    EXPECT_EQ(cv::norm(reader.Clean(0, k).pixels, reader.Turb(0, k).pixels, cv::NORM_INF), 0);
}

// A walker that goes to the left faces there: the mirror image of one that goes to the right.
TEST(ProgramScenes, ObjectsFaceWhereTheyGo) {
  const TempFolder folder;
  const auto mask_of = [&](double direction_deg) {
    folder.Put("c.json", SetConfig("sequence", 1,
                                   {{"size", {65, 48}},
                                    {"objects",
                                     {{{"drawn", "walker"},
                                       {"height_px", 30},
                                       {"motion", {{"direction_deg", direction_deg}, {"speed_px", 3}}}}}},
                                    {"output", {{"truth", {"mask"}}}}}));
    fs::remove_all(folder / "set");
    ExpectDone(Generate(folder, "c.json", "set"));
    return dataset::DatasetReader(folder / "set").TruthMask(0, 1).value();
  };
  cv::Mat mirrored;
  cv::flip(mask_of(180), mirrored, 1);
  EXPECT_LE(cv::norm(mirrored, mask_of(0), cv::NORM_INF), 1.001 / 255);
}

}  // namespace
}  // namespace shimmer::app
