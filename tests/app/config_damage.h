// Configs that somebody or something has damaged.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace shimmer::app {

class Damage {
 public:
  explicit Damage(uint32_t seed = 20240617) : random_(seed) {}

  std::string Apply(std::string text) {
    for (int times = 1 + Below(2); times > 0; --times) text = Once(std::move(text));
    return text;
  }

  size_t Below(size_t end) { return random_() % end; }  // std's distributions differ between libraries

 private:
  std::string Once(std::string text) {
    switch (Below(8)) {
      case 0:
        text[Below(text.size())] ^= static_cast<char>(1 << Below(8));
        return text;
      case 1:
        text[Below(text.size())] = static_cast<char>(Below(256));
        return text;
      case 2:
        return text.substr(0, 1 + Below(text.size()));
      case 3:
        return Cut(std::move(text));
      case 4:
        return text.insert(Below(text.size()), Piece(text));  // doubled keys among others
      case 5:
        return text.insert(Below(text.size()), std::string(100000, "[{\"a"[Below(4)]));
      case 6:
        return Replaced(std::move(text));
      default:
        std::swap(text[Below(text.size())], text[Below(text.size())]);
        return text;
    }
  }

  std::string Piece(const std::string& text) {
    const size_t start = text.find_first_of("\",", Below(text.size()));
    if (start == std::string::npos) return text.substr(0, 1);
    return text.substr(start, text.find_first_of(",}", start + 1) - start);
  }

  std::string Cut(std::string text) {
    const size_t start = Below(text.size());
    text.erase(start, 1 + Below(20));
    return text.empty() ? "{" : text;
  }

  // Puts something odd in the place of a number.
  std::string Replaced(std::string text) {
    static const std::vector<std::string> odd = {"-1",
                                                 "1e999",
                                                 "NaN",
                                                 "null",
                                                 "{}",
                                                 "[]",
                                                 "\"\"",
                                                 "4294967297",
                                                 "3.9",
                                                 "18446744073709551616",
                                                 "1e-400",
                                                 "-0.0",
                                                 "true",
                                                 "[[[]]]",
                                                 "1e308",
                                                 R"({"normal":[0,0]})",
                                                 R"({"choice":[{}]})",
                                                 "\"\\u0000\"",
                                                 "5e-324"};
    const size_t start = text.find_first_of("0123456789", Below(text.size()));
    if (start == std::string::npos) return text;
    const size_t end = std::min(text.find_first_not_of("0123456789.", start), text.size());
    return text.replace(start, end - start, odd[Below(odd.size())]);
  }

  std::mt19937 random_;
};

}  // namespace shimmer::app
