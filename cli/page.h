// Parts that pages of ours are made of. What is called html is taken as it is, all else is escaped.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shimmer::cli {

// Up to and with <body>. The page may show what it holds itself, and load nothing.
std::string PageStart(const std::string& title, std::string_view style);

std::string Section(const std::string& id, const std::string& title, const std::string& note,
                    const std::string& html);

// A figure that is read first: value is large, name small below it.
std::string Tile(const std::string& name, const std::string& value, bool bad = false);

// A figure with its name and notes (empty ones are left out) above.
std::string Chart(const std::string& key, const std::vector<std::string>& notes, const std::string& html);

// An item of <ol class="bars">: a bar below its texts.
struct BarTexts {
  std::string name, count, share, title;
};
// data_html: attributes; percent: of the widest bar.
std::string Bar(const BarTexts& texts, const std::string& data_html, double percent);

}  // namespace shimmer::cli
