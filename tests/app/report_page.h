// A data set's report as tests read it: the page that `shimmer report` writes, and the numbers in its charts.
#pragma once

#include <map>
#include <regex>

#include "tests/app/program.h"

namespace shimmer::app {

// The page without the contact sheet's bytes.
inline std::string ReportOf(const TempFolder& folder, const std::string& set) {
  const Ran ran = Shimmer(folder, {"report", set});
  ExpectDone(ran);
  EXPECT_EQ(ran.out, set + "/report.html\n");
  std::string page = ReadText(folder / set / "report.html");
  if (const size_t start = page.find("base64,"); start != std::string::npos)
    page.erase(start + 7, page.find('"', start) - start - 7);
  return page;
}

inline std::vector<std::smatch> AllOf(const std::string& text, const std::string& pattern) {
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

inline std::map<std::string, Chart> ChartsIn(const std::string& page) {
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

}  // namespace shimmer::app
