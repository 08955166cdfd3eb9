// Damaged configs: each is read or refused with a message, whatever the damage.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "sim/app/config/config.h"
#include "sim/app/config/json_reader.h"
#include "tests/app/config_errors.h"

namespace shimmer::app {
namespace {

class Damage {
 public:
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

  std::mt19937 random_{20240617};
};

TEST(ConfigFuzz, DamagedConfigsAreReadOrRefused) {
  Damage damage;
  int good = 0, refused = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string text = damage.Apply(kFullConfig);
    try {
      const ConfigFile file = ConfigFile::Parse(text);
      const ConfigFile again = ConfigFile::Parse(file.resolved().dump());
      EXPECT_EQ(file.Hash(), again.Hash());
      file.Draw(damage.Below(1000), nullptr);
      ++good;
    } catch (const ConfigError& error) {
      const std::string message = error.what();
      EXPECT_FALSE(message.empty());
      EXPECT_EQ((error.pointer() + message).find('\n'), std::string::npos) << message;
      EXPECT_LT(message.size(), 400u) << message;
      ++refused;
    }
  }
  EXPECT_GT(good, 50);  // else the damage is such that nothing behind the reader was tried
  EXPECT_GT(refused, 1000);
}

TEST(ConfigFuzz, DamagedSetsAreReadOrRefused) {
  Damage damage;
  const std::string sets[] = {R"(tilt.strength_px={"normal": [5, 2], "clip": [1, 9]})", "source.images=null",
                              R"(size={"choice": [[5, 6], [7, 8]], "weights": [1, 2]})", "output.name=night"};
  for (int i = 0; i < 500; ++i) {
    const std::string error = ErrorOf(kFullConfig, {damage.Apply(sets[damage.Below(4)])});
    EXPECT_FALSE(error.ends_with(": ")) << error;
  }
}

TEST(ConfigFuzz, EveryBeginningOfAConfigIsRefused) {
  const std::string full = kFullConfig;
  for (size_t bytes = 0; bytes < full.size(); ++bytes)
    EXPECT_NE(ErrorOf(full.substr(0, bytes)), "no error") << bytes;
}

}  // namespace
}  // namespace shimmer::app
