// What `shimmer report` says of sets with few clips, failed ones, or damage.
#include "tests/app/report_page.h"

namespace shimmer::app {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Reports, OfFewClipsOrNone) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"tilt", {{"strength_px", {{"uniform", {1, 2}}}}}}}));
  ExpectDone(Generate(folder, "c.json", "set", {"--clip", "2"}));
  std::string page = ReportOf(folder, "set");
  EXPECT_THAT(page, HasSubstr("<b>1</b><span>of 4 clips done</span>"));
  EXPECT_THAT(page, HasSubstr("<b>3</b><span>missing</span>"));
  EXPECT_EQ(ChartsIn(page).at("tilt.strength_px").bins.size(), 1u);

  folder.Put("set/manifest.jsonl", std::string());
  page = ReportOf(folder, "set");
  EXPECT_THAT(page, HasSubstr("No clip is done"));
  EXPECT_THAT(page, HasSubstr("<b>4</b><span>missing</span>"));
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_TRUE(ChartsIn(page).empty());

  // More clips than the config asks for by now.
  ExpectDone(Generate(folder, "c.json", "more"));
  ExpectDone(Generate(folder, "c.json", "more", {"--set", "clips=2"}));
  page = ReportOf(folder, "more");
  EXPECT_THAT(page, HasSubstr("<b>4</b><span>of 2 clips done</span>"));
  EXPECT_THAT(page, HasSubstr("<b>0</b><span>missing</span>"));
}

TEST(Reports, OfTurbulenceThatIsNone) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"tilt", {{"strength_px", 0}}}, {"blur", {{"max_sigma_px", 0}}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  const auto charts = ChartsIn(ReportOf(folder, "set"));
  for (const char* key : {"tilt_rms_px", "mean_sigma_px"}) {
    ASSERT_EQ(charts.at(key).bins.size(), 1u);
    EXPECT_EQ(charts.at(key).bins[0].count, 4);
  }
}

TEST(Reports, CountSourcesAndFailures) {
  const TempFolder folder;
  const std::string good = "pictures/a <i>&\"quote\"'.png",
                    bad = "pictures/b <script>alert(1)</script\xFF.png";
  WritePng(folder, good, dataset::RandomImage({60, 50}, 3, 1));
  folder.Put(bad, std::string("no picture"));
  folder.Put("c.json", SmallConfig({{"clips", 12}, {"source", {{"images", "pictures"}}}}));
  EXPECT_EQ(Generate(folder, "c.json", "set").exit_code, 1);
  const std::string page = ReportOf(folder, "set");

  int64_t failed = 0;
  for (const Json& line : ManifestLines(folder / "set")) failed += line["status"] == "failed";
  ASSERT_GT(failed, 0);
  ASSERT_LT(failed, 12);
  const auto rows = AllOf(page, "<tr data-clips=\"(\\d+)\"><td>([^\n]*)</td><td class");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(std::stoll(rows[0][1]), failed);
  EXPECT_THAT(rows[0][2].str(),
              HasSubstr("b &lt;script&gt;alert(1)&lt;/script\xEF\xBF\xBD.png: not a picture"));
  EXPECT_THAT(page,
              HasSubstr("<div class=\"tile bad\"><b>" + std::to_string(failed) + "</b><span>failed</span>"));
  EXPECT_EQ(
      ChartsIn(page).at("source.path").bars,
      (std::map<std::string, int64_t>{{"pictures/a &lt;i&gt;&amp;&quot;quote&quot;&#39;.png", 12 - failed}}));
  EXPECT_THAT(page, HasSubstr("1 of 2 source files is seen"));
  for (const char* part : {"<i>", "<script", "\xFF"}) EXPECT_THAT(page, Not(HasSubstr(part)));
}

// Lines as a set of a quarter of a million clips may have them, though nearly all have failed.
TEST(Reports, StayShortWhateverFails) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"clips", 2}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  std::string manifest = ReadText(folder / "set/manifest.jsonl");
  for (int clip = 2; clip < 3000; ++clip) {
    const std::string error = clip < 2500 ? "the same" : "error " + std::to_string(clip);
    manifest += Json{{"clip", clip}, {"status", "failed"}, {"error", error}}.dump() + "\n";
  }
  folder.Put("set/manifest.jsonl", manifest);
  const std::string page = ReportOf(folder, "set");
  const auto rows =
      AllOf(page, "<tr data-clips=\"(\\d+)\"><td>([^\n]*)</td><td class=\"count\">[^<]*</td><td>([^<]*)<");
  ASSERT_EQ(rows.size(), 201u);
  EXPECT_EQ(rows[0][2], "the same");
  EXPECT_THAT(rows[0][3].str(), HasSubstr("2, 3, 4, 5"));
  EXPECT_THAT(rows[0][3].str(), HasSubstr("21 and 2,478 more"));
  EXPECT_EQ(rows[1][2], "error 2500");
  EXPECT_EQ(rows[200][2], "and 301 other errors");
  int64_t clips = 0;
  for (const auto& row : rows) clips += std::stoll(row[1]);
  EXPECT_EQ(clips, 2998);
}

TEST(Reports, OfWhatIsNotThere) {
  const TempFolder folder;
  ExpectOneLine(Shimmer(folder, {"report", "no"}), 1, {"no: not a data set"});
  ExpectOneLine(Shimmer(folder, {"report"}), 2, {"DIR"});
  folder.Put("c.json", SmallConfig());
  ExpectDone(Generate(folder, "c.json", "set"));
  folder.Put("set/report.html", std::string("old"));
  fs::resize_file(folder / "set/clips/000000/turb/0001.png", 60);
  ExpectOneLine(Shimmer(folder, {"report", "set"}), 1, {"0001.png: damaged picture"});
  EXPECT_EQ(ReadText(folder / "set/report.html"), "old");
}

}  // namespace
}  // namespace shimmer::app
