// What `shimmer report` says of sets of every kind.
#include "cli/number_text.h"
#include "tests/app/report_page.h"

namespace shimmer::app {
namespace {

using testing::HasSubstr;
using testing::Not;

const Json kManyDraws = {{"clips", 40},
                         {"size", {{"choice", {{24, 16}, {16, 24}, {32, 8}}}}},
                         {"source", {{"drawn", {{"choice", {"star", "chart"}}, {"weights", {3, 1}}}}}},
                         {"tilt",
                          {{"strength_px", {{"log_uniform", {0.5, 10}}}},
                           {"base_frequency", {{"uniform", {0.015, 0.06}}}},
                           {"octaves", {{"uniform", {6, 8}}}},
                           {"kernel", {{"choice", {0.5, 0.6}}}},
                           {"persistence", {{"uniform", {0.5, 0.5}}}}}},
                         {"blur", {{"max_sigma_px", {{"normal", {1, 0.3}}, {"clip", {0.5, 2}}}}}}};

// Bins hold as many clips as have such a number (edges are printed with 9 digits), bars as many as have the
// value.
void ExpectShows(const Chart& chart, const std::vector<Json>& values) {
  int64_t in_bins = 0, in_bars = 0;
  for (const Chart::Bin& bin : chart.bins) {
    const double slack = 1e-6 * (bin.high - bin.low);
    const auto within = [&](double by) {
      return std::ranges::count_if(
          values, [&](const Json& value) { return value >= bin.low - by && value <= bin.high + by; });
    };
    EXPECT_GE(bin.count, within(-slack));
    EXPECT_LE(bin.count, within(slack));
    in_bins += bin.count;
  }
  for (const auto& [name, count] : chart.bars) in_bars += count;
  EXPECT_EQ(in_bins + in_bars, std::ssize(values));
  EXPECT_TRUE(chart.bins.empty() || chart.bars.empty());
}

TEST(Reports, ShowWhatTheManifestSays) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig(kManyDraws));
  ExpectDone(Generate(folder, "c.json", "set"));
  const std::string page = ReportOf(folder, "set");
  const auto charts = ChartsIn(page);

  std::map<std::string, std::vector<Json>> values;
  for (const Json& line : ManifestLines(folder / "set")) {
    for (const auto& [key, value] : line["drawn"].items()) values[key].push_back(value);
    for (const char* key : {"tilt_rms_px", "mean_sigma_px"}) values[key].push_back(line[key]);
  }
  ASSERT_EQ(values.size(), 10u);
  std::set<std::string> keys, shown;
  for (const auto& [key, numbers] : values) keys.insert(key);
  for (const auto& [key, chart] : charts) shown.insert(key);
  EXPECT_EQ(shown, keys);
  for (const auto& [key, numbers] : values) {
    SCOPED_TRACE(key);
    ASSERT_EQ(numbers.size(), 40u);
    ExpectShows(charts.at(key), numbers);
  }
  const auto times = [&](const char* key, const Json& value) {
    return std::ranges::count(values[key], value);
  };
  EXPECT_EQ(charts.at("source.drawn").bars,
            (std::map<std::string, int64_t>{{"star", times("source.drawn", "star")},
                                            {"chart", times("source.drawn", "chart")}}));
  EXPECT_EQ(charts.at("size").bars.at("16x24"), times("size", {16, 24}));
  EXPECT_EQ(charts.at("tilt.kernel").bars.at("0.5"), times("tilt.kernel", 0.5));
  EXPECT_EQ(charts.at("tilt.octaves").bins.size(), 3u);
  EXPECT_EQ(charts.at("tilt.persistence").bins.size(), 1u);  // all are equal
  EXPECT_GE(charts.at("tilt.strength_px").bins.size(), 15u);

  for (const char* part :
       {"<h1>shimmer</h1>", "layout sequence, 2 frames a clip, 8-bit png",
        "<b>40</b><span>of 40 clips done</span>", "<b>80</b><span>frames</span>",
        "<b>0</b><span>failed</span>", "log_uniform [0.5, 10]", "normal [1, 0.3], clip [0.5, 2]",
        "choice of 2, weights [3, 1]", "No clip has failed.", "data:image/jpeg;base64,", "px, log scale",
        "16x24, 24x16, 32x8 px"})
    EXPECT_THAT(page, HasSubstr(part));
}

// One file that needs nothing else, runs nothing, and shows no number that is none.
TEST(Reports, StandAlone) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig(kManyDraws));
  ExpectDone(Generate(folder, "c.json", "set"));
  auto before = Tree(folder / "set");
  before.erase("report.html");
  const std::string page = ReportOf(folder, "set");
  for (const char* part : {"<script", "<link", "http:", "https:", "url(", "@import", "nan", "NaN", "-0 "})
    EXPECT_THAT(page, Not(HasSubstr(part)));
  EXPECT_TRUE(AllOf(page, "[ >\"]-?inf[^a-z]").empty());
  EXPECT_THAT(page, Not(HasSubstr(folder.path().string())));
  auto after = Tree(folder / "set");
  EXPECT_EQ(after.erase("report.html"), 1u);
  EXPECT_EQ(after, before);
  // Every element that is opened is closed.
  for (const char* element : {"section", "figure", "svg", "g", "text", "ol", "li", "p", "table", "div", "dl"})
    EXPECT_EQ(AllOf(page, "<" + std::string(element) + "[ >]").size(),
              AllOf(page, "</" + std::string(element) + ">").size())
        << element;
}

TEST(Reports, OfTheSameSetAreTheSame) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig(kManyDraws));
  ExpectDone(Generate(folder, "c.json", "one"));
  ExpectDone(
      Generate(folder, "c.json", "deeper/two", {"--clip", "30", "--threads", "1"}));  // first in the manifest
  ExpectDone(Generate(folder, "c.json", "deeper/two"));
  ReportOf(folder, "one");
  ReportOf(folder, "deeper/two");
  const std::string page = ReadText(folder / "one/report.html");
  EXPECT_EQ(ReadText(folder / "deeper/two/report.html"), page);
  ReportOf(folder, "one");  // again, over the old one
  EXPECT_EQ(ReadText(folder / "one/report.html"), page);
  EXPECT_LT(page.size(), 3'000'000u);
}

TEST(Reports, OfShardsAreThatOfTheWholeSet) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig(kManyDraws));
  ExpectDone(Generate(folder, "c.json", "whole"));
  for (const char* shard : {"1/2", "0/2"})
    ExpectDone(Generate(folder, "c.json", "shards", {"--shard", shard}));
  ReportOf(folder, "whole");
  ReportOf(folder, "shards");
  EXPECT_EQ(ReadText(folder / "shards/report.html"), ReadText(folder / "whole/report.html"));
}

TEST(Reports, OfEveryLayout) {
  const TempFolder folder;
  for (const std::string layout : {"sequence", "pairs", "restormer", "basicsr", "webdataset"}) {
    SCOPED_TRACE(layout);
    folder.Put("c.json", SmallConfig({{"output", {{"layout", layout}, {"any_length", true}}}}));
    ExpectDone(Generate(folder, "c.json", layout));
    uint64_t bytes = 0;
    for (const Json& line : ManifestLines(folder / layout))
      for (const Json& file : line["files"]) bytes += file["bytes"].get<uint64_t>();
    const std::string page = ReportOf(folder, layout);
    EXPECT_THAT(page, HasSubstr("layout " + layout + ", "));
    EXPECT_THAT(page, HasSubstr("<b>" + cli::BytesText(bytes) + "</b><span>on disk</span>"));
    EXPECT_THAT(page, HasSubstr("<img"));
  }
}

TEST(Reports, OfLayoutPairs) {
  const TempFolder folder;
  folder.Put("c.json",
             SmallConfig({{"output", {{"layout", "pairs"}, {"name", "warm_air"}, {"truth", {"tilt"}}}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  const std::string page = ReportOf(folder, "set");
  for (const char* part : {"<title>warm_air: report</title>", "layout pairs, 1 frame a clip", "<dd>tilt</dd>",
                           "<b>4</b><span>frames</span>", "None: every clip has the same values."})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST(Reports, SumBytesWhereTheManifestHasThem) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  ExpectDone(Generate(folder, "c.json", "set"));
  std::string manifest;
  uint64_t bytes = 0;
  for (Json line : ManifestLines(folder / "set")) {
    for (Json& file : line["files"]) {
      const uint64_t file_bytes = 500'000'000 + line["clip"].get<uint64_t>();
      file["bytes"] = file_bytes;
      bytes += file_bytes;
    }
    manifest += line.dump() + "\n";
  }
  folder.Put("set/manifest.jsonl", manifest);
  ASSERT_EQ(bytes / 10'000'000, 600u);
  EXPECT_THAT(ReportOf(folder, "set"), HasSubstr("<b>6 GB</b><span>on disk</span>"));
}

// Of each object what it has drawn, and whether it is there.
TEST(Reports, ShowWhatObjectsHaveDrawn) {
  const TempFolder folder;
  folder.Put("c.json",
             SmallConfig({{"clips", 20},
                          {"objects",
                           {{{"drawn", "disc"}, {"height_px", 9}},
                            {{"drawn", {{"choice", {"box", "walker"}}}},
                             {"chance", 0.5},
                             {"height_px", {{"uniform", {5, 9}}}},
                             {"motion", {{"speed_px", {{"uniform", {0, 1}}}}}}},
                            {{"drawn", "disc"}, {"height_px", 9}, {"chance", {{"choice", {0.3, 0.8}}}}}}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  std::map<std::string, std::vector<Json>> values;
  for (const Json& line : ManifestLines(folder / "set"))
    for (const auto& [key, value] : line["drawn"].items()) values[key].push_back(value);
  const auto charts = ChartsIn(ReportOf(folder, "set"));
  for (const char* key : {"objects.1.drawn", "objects.1.present", "objects.1.height_px",
                          "objects.1.motion.speed_px", "objects.2.chance", "objects.2.present"}) {
    SCOPED_TRACE(key);
    ASSERT_EQ(values[key].size(), 20u);
    ASSERT_TRUE(charts.contains(key));
    ExpectShows(charts.at(key), values[key]);
  }
  EXPECT_FALSE(charts.contains("objects.0.present"));
  int64_t present = 0;
  for (const Json& value : values["objects.1.present"]) present += value.get<bool>();
  EXPECT_EQ(charts.at("objects.1.present").bars.at("true"), present);
}

}  // namespace
}  // namespace shimmer::app
