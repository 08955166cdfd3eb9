// The page of an evaluation as tests read it: its sections and the tables in them.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <string>
#include <vector>

namespace shimmer::restore::app {

// The groups of each match; the first is all of it.
inline std::vector<std::vector<std::string>> AllIn(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::vector<std::string>> matches;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
    matches.emplace_back(match->begin(), match->end());
  return matches;
}

struct PageCell {
  std::string number;  // data-value; empty where there is none
  std::string text;    // without its tags
  bool bold;
};

struct PageTable {
  std::vector<std::map<std::string, PageCell>> rows;  // by the keys of the columns

  const PageCell& At(size_t row, const std::string& key) const { return rows.at(row).at(key); }
  std::vector<std::string> Texts(const std::string& key) const {
    std::vector<std::string> texts;
    for (size_t row = 0; row < rows.size(); ++row) texts.push_back(At(row, key).text);
    return texts;
  }
};

inline std::string SectionOf(const std::string& page, const std::string& id) {
  const size_t start = page.find("<section id=\"" + id + "\">");
  return start == std::string::npos ? "" : page.substr(start, page.find("</section>", start) - start);
}

// The first table of a section.
inline PageTable TableOf(const std::string& page, const std::string& section) {
  std::string html = SectionOf(page, section);
  html = html.substr(0, html.find("</table>"));
  std::vector<std::string> keys;
  for (const auto& head : AllIn(html, "data-key=\"([^\"]*)\"")) keys.push_back(head[1]);
  PageTable table;
  for (const auto& row : AllIn(html.substr(html.find("<tbody>")), "<tr>(.*)</tr>")) {
    std::map<std::string, PageCell> cells;
    const std::string inner = row[1];
    for (const auto& cell : AllIn(inner, "<t[hd]([^>]*)>(.*?)</t[hd]>")) {
      const std::string attributes = cell[1], content = cell[2];
      const auto value = AllIn(attributes, "data-value=\"([^\"]*)\"");
      cells[keys.at(cells.size())] = {value.empty() ? "" : value[0][1],
                                      std::regex_replace(content, std::regex("<[^>]*>"), ""),
                                      content.find("<b>") != std::string::npos};
    }
    EXPECT_EQ(cells.size(), keys.size()) << section;
    table.rows.push_back(cells);
  }
  return table;
}

}  // namespace shimmer::restore::app
