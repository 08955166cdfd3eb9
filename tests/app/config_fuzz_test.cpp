// Damaged configs: each is read or refused with a message, whatever the damage.
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/app/config/config.h"
#include "sim/app/config/json_reader.h"
#include "tests/app/config_damage.h"
#include "tests/app/config_errors.h"

namespace shimmer::app {
namespace {

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
