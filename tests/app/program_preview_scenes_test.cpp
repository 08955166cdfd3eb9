// What `shimmer preview` and `shimmer report` show of moving scenes.
#include <opencv2/imgproc.hpp>

#include "sim/app/scene_marks.h"
#include "tests/app/report_page.h"

namespace shimmer::app {
namespace {

using testing::HasSubstr;
using testing::Not;

// Grey all over, with a box that drives along, seen by a camera that jumps: 256 px wide, as a sheet's cell.
std::string Scene(const Json& truth, const Json& changes = Json::object()) {
  Json config = Json::parse(
      SmallConfig({{"clips", 1},
                   {"frames", 3},
                   {"size", {256, 128}},
                   {"source", {{"images", "in.png"}}},
                   {"tilt", {{"strength_px", 1}}},
                   {"camera", {{"shake", "list"}, {"shifts", {{0, 0}, {12, -8}, {3, 2}}}}},
                   {"objects", {{{"drawn", "box"}, {"height_px", 30}, {"motion", {{"speed_px", 0}}}}}},
                   {"output", {{"truth", truth}}}}));
  for (const auto& [key, value] : changes.items()) config[key].update(value);
  return config.dump();
}

void PutSource(const TempFolder& folder) {
  WritePng(folder, "in.png", cv::Mat(400, 500, CV_32FC3, cv::Scalar::all(0.5)));
}

cv::Mat SheetOf(const TempFolder& folder, const std::string& set) {
  ExpectDone(Shimmer(folder, {"preview", set, "--out", set + ".png"}));
  cv::Mat sheet;
  dataset::ReadImage(folder / (set + ".png")).pixels.convertTo(sheet, CV_8U, 255);
  return sheet;
}

cv::Mat Where(const cv::Mat& picture, const cv::Vec3b& colour) {
  cv::Mat same;
  cv::inRange(picture, colour, colour, same);
  return same;
}

struct Outlines {
  cv::Rect clean, turb;
};

Outlines OutlinesIn(const cv::Mat& sheet) {
  const cv::Mat green = Where(sheet, kOutline);
  const int middle = 28 + 256 + 9;  // between the first two columns
  return {cv::boundingRect(green.colRange(0, middle)),
          cv::boundingRect(green.colRange(middle, green.cols)) + cv::Point(middle - 256 - 18, 0)};
}

TEST(ScenePreviews, OutlinesMoveWithTheCamera) {
  const TempFolder folder;
  PutSource(folder);
  const Json kinds = {"mask", "shake"}, mask = {"mask"};
  folder.Put("c.json", Scene(kinds));
  ExpectDone(Generate(folder, "c.json", "both"));
  const cv::Mat sheet = SheetOf(folder, "both");
  const Outlines outlines = OutlinesIn(sheet);
  EXPECT_EQ(outlines.turb - cv::Point(12, -8), outlines.clean);
  EXPECT_GT(cv::countNonZero(Where(sheet, kShakePlace)), 0);

  // Where objects are is truth: the outermost pixels that they cover by half.
  const dataset::DatasetReader reader(folder / "both");
  const cv::Rect truth = cv::boundingRect(cv::Mat(reader.TruthMask(0, 1).value() >= 0.5));
  EXPECT_EQ(outlines.clean.size(), truth.size());
  EXPECT_EQ(outlines.clean.x, 28 + truth.x);

  // The shake is known by its config, too; but its path is drawn where it is truth.
  folder.Put("c.json", Scene(mask));
  ExpectDone(Generate(folder, "c.json", "mask"));
  const cv::Mat without_path = SheetOf(folder, "mask");
  EXPECT_EQ(OutlinesIn(without_path).turb, outlines.turb);
  EXPECT_EQ(cv::countNonZero(Where(without_path, kShakePlace)), 0);

  folder.Put("c.json", Scene(mask, {{"camera", {{"shaken_clean", true}}}}));
  ExpectDone(Generate(folder, "c.json", "shaken"));
  const Outlines shaken = OutlinesIn(SheetOf(folder, "shaken"));
  EXPECT_EQ(shaken.clean, shaken.turb);
  EXPECT_EQ(shaken.turb, outlines.turb);

  for (const std::string set : {"both", "mask", "shaken"})
    ExpectDone(Shimmer(folder, {"preview", set, "--out", set + ".gif"}));
  EXPECT_NE(ReadText(folder / "both.gif"), ReadText(folder / "mask.gif"));
}

TEST(ScenePreviews, WithoutTruthOfThemShowNothingOfIt) {
  const TempFolder folder;
  PutSource(folder);
  const Json still = {{"camera", {{"shake", "none"}, {"shifts", Json::array()}}}};
  const Json none = Json::array(), shake = {"shake"};
  folder.Put("c.json", Scene(none, still));
  ExpectDone(Generate(folder, "c.json", "bare"));
  folder.Put("c.json", Scene(shake, still));  // all zero
  ExpectDone(Generate(folder, "c.json", "zero"));
  const cv::Mat sheet = SheetOf(folder, "bare");
  EXPECT_EQ(cv::countNonZero(Where(sheet, kOutline)), 0);
  SheetOf(folder, "zero");
  EXPECT_EQ(ReadText(folder / "bare.png"), ReadText(folder / "zero.png"));
  for (const std::string set : {"bare", "zero"})
    ExpectDone(Shimmer(folder, {"preview", set, "--out", set + ".gif"}));
  EXPECT_EQ(ReadText(folder / "bare.gif"), ReadText(folder / "zero.gif"));
}

// Fields that objects scale can't be computed without them.
TEST(ScenePreviews, LeaveOutFieldsOfOwnDistances) {
  const TempFolder folder;
  PutSource(folder);
  const auto of = [&](const std::string& name, const Json& truth, double distance) {
    Json config = Json::parse(Scene(truth));
    config["objects"][0]["distance"] = distance;
    folder.Put("c.json", config.dump());
    ExpectDone(Generate(folder, "c.json", name));
    SheetOf(folder, name);
    return ReadText(folder / (name + ".png"));
  };
  const Json none = Json::array(), both = {"tilt", "sigma"};
  EXPECT_EQ(of("far", none, 1), of("far_truth", both, 1));
  EXPECT_NE(of("near", none, 0.5), of("near_truth", both, 0.5));
}

TEST(SceneReports, ShowShakeAndMovingShare) {
  const TempFolder folder;
  PutSource(folder);
  WritePng(folder, "bird.png", cv::Mat(20, 20, CV_32FC4, cv::Scalar(0.2, 0.3, 0.4, 1)));
  const Json none = Json::array(), mask = {"mask", "shake"};
  Json config = Json::parse(Scene(mask));
  config["objects"].push_back({{"images", "bird.png"}, {"height_px", 12}});
  folder.Put("c.json", config.dump());
  ExpectDone(Generate(folder, "c.json", "set"));
  const std::string page = ReportOf(folder, "set");
  const auto charts = ChartsIn(page);
  const Json line = ManifestLines(folder / "set").at(0);
  for (const char* key : {"shake_rms_px", "moving_share"}) {
    ASSERT_TRUE(charts.contains(key)) << key;
    ASSERT_EQ(charts.at(key).bins.size(), 1u) << key;
    const Chart::Bin& bin = charts.at(key).bins[0];
    EXPECT_EQ(bin.count, 1);
    EXPECT_GE(line[key].get<double>(), bin.low - 1e-6);
    EXPECT_LE(line[key].get<double>(), bin.high + 1e-6);
  }
  for (const char* part : {"<dd>1 file and 1 file of masks and objects</dd>", "1 of 1 source file is seen",
                           "these and 1 file of masks and objects", "Green lines", "The inset"})
    EXPECT_THAT(page, HasSubstr(part));

  folder.Put("c.json", Scene(none, {{"camera", {{"shake", "none"}, {"shifts", Json::array()}}}}));
  ExpectDone(Generate(folder, "c.json", "still"));
  const std::string still = ReportOf(folder, "still");
  for (const char* part :
       {"shake_rms_px\"", "moving_share\"", "masks and objects", "Green lines", "The inset"})
    EXPECT_THAT(still, Not(HasSubstr(part)));
}

}  // namespace
}  // namespace shimmer::app
