#include <gtest/gtest.h>

#include <map>
#include <set>

#include "sim/app/config/config.h"
#include "sim/app/config/distribution.h"
#include "tests/app/config_errors.h"

namespace shimmer::app {
namespace {

ConfigFile WithTilt(const std::string& keys, const std::string& rest = "\"seed\": 3") {
  return ConfigFile::Parse(WithSource("\"tilt\": {" + keys + "}, " + rest));
}

TEST(Draw, EveryDistributionStaysInItsSupportAndFillsIt) {
  const ConfigFile file = ConfigFile::Parse(kFullConfig);
  const auto is_size = [](const Config& c, int width, int height) {
    return c.size == cv::Size(width, height);
  };
  std::map<std::string, std::set<double>> values;
  constexpr int kClips = 2000;
  int wide = 0;
  for (uint64_t clip = 0; clip < kClips; ++clip) {
    const Config c = file.Draw(clip, nullptr);
    EXPECT_TRUE(is_size(c, 256, 256) || is_size(c, 320, 200));
    wide += is_size(c, 320, 200);
    values["scale"].insert(c.source.scale);
    values["strength"].insert(c.tilt.strength_px);
    values["frequency"].insert(c.tilt.base_frequency);
    values["lacunarity"].insert(c.tilt.lacunarity);
    values["octaves"].insert(c.tilt.octaves);
    values["lattice"].insert(static_cast<int>(c.tilt.lattice));
    values["kernel"].insert(c.tilt.kernel);
    values["blur octaves"].insert(c.blur.octaves);
    EXPECT_LE(c.blur.min_sigma_px, c.blur.max_sigma_px);
    EXPECT_EQ(c.tilt.persistence, 0.45);
    EXPECT_EQ(c.output.name, "night");
  }
  // 2 % of the range at an end hold 1 % of the draws or more: all 2000 miss them with a chance of 0.99^2000 <
  // 2e-9.
  const auto fills = [&](const std::string& name, double low, double high) {
    EXPECT_GE(*values[name].begin(), low) << name;
    EXPECT_LE(*values[name].rbegin(), high) << name;
    EXPECT_NEAR(*values[name].begin(), low, 0.02 * (high - low)) << name;
    EXPECT_NEAR(*values[name].rbegin(), high, 0.02 * (high - low)) << name;
  };
  fills("scale", 0.5, 1);
  fills("strength", 1, 10);
  fills("frequency", 0.015, 0.06);
  EXPECT_GE(*values["lacunarity"].begin(), 1.5);
  EXPECT_LE(*values["lacunarity"].rbegin(), 2.5);
  EXPECT_EQ(values["octaves"], (std::set<double>{3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(values["blur octaves"], (std::set<double>{7, 8, 9, 10, 11}));
  EXPECT_EQ(values["lattice"], (std::set<double>{0, 1}));
  EXPECT_EQ(values["kernel"], (std::set<double>{0.5, 0.6}));
  EXPECT_NEAR(wide, kClips / 4, 5 * 19.4);  // 5 standard deviations of a binomial count
}

TEST(Draw, WholeNumbersOfEveryFormReachBothEnds) {
  for (const char* form : {R"({"uniform": [2, 5]})", R"({"log_uniform": [2, 5]})",
                           R"({"normal": [3, 2], "clip": [2, 5]})", R"({"choice": [2, 3, 4, 5]})"}) {
    const ConfigFile file = WithTilt(std::string("\"octaves\": ") + form);
    std::set<int> values;
    for (uint64_t clip = 0; clip < 300; ++clip) values.insert(file.Draw(clip, nullptr).tilt.octaves);
    EXPECT_EQ(values, (std::set<int>{2, 3, 4, 5})) << form;
  }
}

TEST(Draw, RecordsWhatIsDrawnAndNothingElse) {
  const ConfigFile file = ConfigFile::Parse(kFullConfig);
  Json drawn;
  const Config config = file.Draw(12, &drawn);
  EXPECT_EQ(drawn["tilt.strength_px"], config.tilt.strength_px);
  EXPECT_EQ(drawn["blur.octaves"], config.blur.octaves);
  EXPECT_EQ(drawn["size"], (Json{config.size.width, config.size.height}));
  EXPECT_EQ(drawn["tilt.lattice"], config.tilt.lattice == sim::LatticeKind::kSeeded ? "seeded" : "classic");
  std::set<std::string> paths;
  for (const auto& [path, value] : drawn.items()) paths.insert(path);
  EXPECT_EQ(paths, (std::set<std::string>{"size", "source.scale", "tilt.strength_px", "tilt.base_frequency",
                                          "tilt.octaves", "tilt.lacunarity", "tilt.temporal_scale",
                                          "tilt.lattice", "tilt.kernel", "blur.min_sigma_px",
                                          "blur.max_sigma_px", "blur.octaves", "blur.tilt_weight"}));
  ConfigFile::Parse(WithSource()).Draw(12, &drawn);
  EXPECT_EQ(drawn, Json::object());
}

TEST(Draw, DependsOnSeedClipAndPathAlone) {
  const std::string strength = R"("strength_px": {"uniform": [1, 10]})";
  const auto drawn = [&](const ConfigFile& file, uint64_t clip) {
    return file.Draw(clip, nullptr).tilt.strength_px;
  };
  const ConfigFile file = WithTilt(strength);
  const double value = drawn(file, 7);
  EXPECT_EQ(drawn(file, 7), value);
  EXPECT_EQ(drawn(WithTilt(strength +
                           R"(, "octaves": {"uniform": [1, 9]}, "base_frequency": {"uniform": [0.1, 0.2]})"),
                  7),
            value);
  EXPECT_EQ(
      drawn(WithTilt(strength, R"("seed": 3, "clips": 1, "size": {"choice": [[5, 5]]}, "colour": "linear")"),
            7),
      value);
  EXPECT_NE(drawn(file, 8), value);
  for (const char* seed : {"0", "1", "4294967299", "18446744073709551615"})
    EXPECT_NE(drawn(WithTilt(strength, std::string("\"seed\": ") + seed), 7), value) << seed;
  // The same distribution under another path is another draw.
  const Config two = WithTilt(R"("lacunarity": {"uniform": [1, 2]})",
                              R"("seed": 3, "blur": {"lacunarity": {"uniform": [1, 2]}})")
                         .Draw(7, nullptr);
  EXPECT_NE(two.tilt.lacunarity, two.blur.lacunarity);
}

TEST(Draw, ChoosesScenesAndNeverWhatWeighsNothing) {
  const ConfigFile file = ConfigFile::Parse(
      R"({"source": {"drawn": {"choice": ["star", "text", "chart"], "weights": [1, 0, 1]}}})");
  EXPECT_EQ(file.fixed().source.drawn, "");  // no one scene holds for the whole set
  std::set<std::string> scenes;
  for (uint64_t clip = 0; clip < 200; ++clip) scenes.insert(file.Draw(clip, nullptr).source.drawn);
  EXPECT_EQ(scenes, (std::set<std::string>{"star", "chart"}));
}

TEST(Draw, ExtremeDistributionsStayInRange) {
  for (const char* form :
       {R"({"normal": [5, 0]})", R"({"normal": [5, 5e-324]})", R"({"normal": [0, 1e-300]})",
        R"({"normal": [5, 1e308]})", R"({"normal": [-1e308, 1e308]})",
        R"({"normal": [0, 1], "clip": [5.9, 64]})", R"({"uniform": [64, 64]})",
        R"({"normal": [70, 1], "clip": [0, 64]})", R"({"log_uniform": [1e-300, 64]})",
        R"({"log_uniform": [64, 64]})", R"({"choice": [64], "weights": [1e-300]})"}) {
    const ConfigFile file = WithTilt(std::string("\"strength_px\": ") + form);
    const Support support = SupportOf(file.resolved()["tilt"]["strength_px"]);
    for (uint64_t clip = 0; clip < 50; ++clip) {
      const double value = file.Draw(clip, nullptr).tilt.strength_px;
      EXPECT_TRUE(value >= support.low && value <= support.high) << form << " drew " << value;
    }
  }
}

// "as": the same place among as many choices, in every clip; without it they are independent.
TEST(ConfigDraw, OneLabelIsDrawnAlike) {
  const ConfigFile file = ConfigFile::Parse(R"({"source": {"drawn": "chart"},
    "tilt": {"strength_px": {"choice": [2, 4, 8], "as": "air"}},
    "blur": {"max_sigma_px": {"choice": [1.5, 3, 6], "as": "air"}, "octaves": {"choice": [1, 2, 4]}}})");
  std::set<std::pair<double, int>> free;
  for (uint64_t clip = 0; clip < 100; ++clip) {
    const Config config = file.Draw(clip, nullptr);
    EXPECT_EQ(config.tilt.strength_px / 2, config.blur.max_sigma_px / 1.5);
    free.insert({config.tilt.strength_px, config.blur.octaves});
  }
  EXPECT_EQ(free.size(), 9u);
  EXPECT_EQ(file.resolved().at("tilt").at("strength_px").at("as"), "air");
  EXPECT_THROW(
      ConfigFile::Parse(
          R"({"source": {"drawn": "chart"}, "tilt": {"strength_px": {"uniform": [1, 2], "as": 3}}})"),
      ConfigError);
}

}  // namespace
}  // namespace shimmer::app
