// What `shimmer report` says of sets of every kind.
#include "sim/app/report.h"

#include <regex>

#include "sim/app/number_text.h"
#include "tests/app/program.h"

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

// The page without the contact sheet's bytes.
std::string ReportOf(const TempFolder& folder, const std::string& set) {
  const Ran ran = Shimmer(folder, {"report", set});
  ExpectDone(ran);
  EXPECT_EQ(ran.out, set + "/report.html\n");
  std::string page = ReadText(folder / set / "report.html");
  if (const size_t start = page.find("base64,"); start != std::string::npos)
    page.erase(start + 7, page.find('"', start) - start - 7);
  return page;
}

std::vector<std::smatch> AllOf(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  return {std::sregex_iterator(text.begin(), text.end(), regex), std::sregex_iterator()};
}

struct Chart {
  struct Bin {
    double low, high;
    int64_t count;
  };
  std::vector<Bin> bins;
  std::map<std::string, int64_t> bars;
};

std::map<std::string, Chart> ChartsIn(const std::string& page) {
  std::map<std::string, Chart> charts;
  for (const auto& figure : AllOf(page, "<figure class=\"chart\" data-key=\"([^\"]*)\">")) {
    const auto start = static_cast<size_t>(figure.position());
    const std::string body = page.substr(start, page.find("</figure>", start) - start);
    Chart& chart = charts[figure[1]];
    for (const auto& bin : AllOf(body, "data-low=\"([^\"]*)\" data-high=\"([^\"]*)\" data-count=\"(\\d+)\""))
      chart.bins.push_back({std::stod(bin[1]), std::stod(bin[2]), std::stoll(bin[3])});
    for (const auto& bar : AllOf(body, "<li data-value=\"([^\"]*)\" data-count=\"(\\d+)\""))
      chart.bars[bar[1]] = std::stoll(bar[2]);
  }
  return charts;
}

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
  const auto before = Tree(folder / "set");
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
    EXPECT_THAT(page, HasSubstr("<b>" + BytesText(bytes) + "</b><span>on disk</span>"));
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
