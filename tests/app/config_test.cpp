#include "sim/app/config/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/app/config/distribution.h"
#include "tests/app/config_errors.h"

namespace shimmer::app {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

ConfigFile Parsed(const std::string& text, const std::vector<std::string>& sets = {}) {
  return ConfigFile::Parse(text, sets);
}

TEST(Config, DefaultsAreThoseOfTheStructs) {
  const ConfigFile file = Parsed(WithSource());
  const Config defaults;
  EXPECT_EQ(file.fixed().seed, defaults.seed);
  EXPECT_EQ(file.fixed().size, defaults.size);
  EXPECT_EQ(file.fixed().tilt.strength_px, defaults.tilt.strength_px);
  EXPECT_EQ(file.fixed().output.name, defaults.output.name);
  EXPECT_EQ(file.fixed().source.drawn, "chart");
  const Json& resolved = file.resolved();
  EXPECT_EQ(resolved["tilt"]["octaves"], defaults.tilt.octaves);
  EXPECT_EQ(resolved["tilt"]["interpolation"], "bicubic");
  EXPECT_EQ(resolved["size"], (Json{256, 256}));
  EXPECT_EQ(resolved["camera"]["shake"], "none");
  EXPECT_EQ(resolved["camera"]["shifts"], Json::array());
  EXPECT_EQ(resolved["objects"], Json::array());
  EXPECT_EQ(resolved["output"]["truth"], Json::array());
}

TEST(Config, ReadsEveryKey) {
  const Config config = Parsed(kFullConfig).fixed();
  EXPECT_EQ(config.seed, 7u);
  EXPECT_EQ(config.clips, 100000);
  EXPECT_EQ(config.frames, 24);
  EXPECT_EQ(config.first_frame, 5);
  EXPECT_EQ(config.source.images, (std::vector<std::string>{"photos/**/*.jpg", "more"}));
  EXPECT_EQ(config.source.crop, Crop::kCentre);
  EXPECT_TRUE(config.source.flip);
  EXPECT_EQ(config.source.start, Start::kFirst);
  EXPECT_EQ(config.tilt.persistence, 0.45);
  EXPECT_EQ(config.tilt.interpolation, sim::Interpolation::kBilinear);
  EXPECT_EQ(config.blur.method, sim::BlurMethod::kStack);
  EXPECT_EQ(config.blur.level_choice, sim::LevelChoice::kNearest);
  EXPECT_EQ(config.colour, sim::Colour::kLinear);
  EXPECT_EQ(config.accuracy.max_error_px, 0.1);
  EXPECT_EQ(config.accuracy.max_error_levels, 0);
  EXPECT_EQ(config.output.format, Format::kExr);
  EXPECT_EQ(config.output.bits, 32);
  EXPECT_EQ(config.output.layout, LayoutKind::kPairs);
  EXPECT_EQ(config.output.truth, (std::vector<std::string>{"tilt", "sigma"}));
  EXPECT_EQ(config.output.name, "night");
  EXPECT_EQ(config.output.test_fraction, 0.1);
  EXPECT_EQ(config.output.frames_per_clip, 3);
}

TEST(Config, SeedsAreAllOfUint64) {
  EXPECT_EQ(Parsed(WithSource(R"("seed": 0)")).fixed().seed, 0u);
  EXPECT_EQ(Parsed(WithSource(R"("seed": 18446744073709551615)")).fixed().seed, UINT64_MAX);
  EXPECT_THAT(ErrorOf(WithSource(R"("seed": 18446744073709551616)")),
              StartsWith("/seed: is 18446744073709551616, "));
  EXPECT_EQ(ErrorOf(WithSource(R"("seed": -1)")), "/seed: is -1, must be in [0, 18446744073709551615]");
  EXPECT_THAT(ErrorOf(WithSource(R"("seed": 1e3)")), StartsWith("/seed: is 1000.0, must be a whole number"));
}

TEST(Config, UnknownKeysNameTheLikelyOne) {
  EXPECT_EQ(ErrorOf(WithSource(R"("tilt": {"strenght_px": 5})")),
            "/tilt/strenght_px: unknown key 'strenght_px'; did you mean 'strength_px'?");
  EXPECT_THAT(ErrorOf(WithSource(R"("tilt": {"strenght": 5})")), HasSubstr("did you mean 'strength_px'?"));
  EXPECT_THAT(ErrorOf(WithSource(R"("Seed": 5)")), HasSubstr("did you mean 'seed'?"));
  EXPECT_THAT(ErrorOf(WithSource(R"("color": "linear")")), HasSubstr("did you mean 'colour'?"));
  EXPECT_THAT(ErrorOf(WithSource(R"("strength_px": 5)")), HasSubstr("did you mean 'tilt.strength_px'?"));
  EXPECT_THAT(ErrorOf(WithSource(R"("tilt": {"colour": "linear"})")),
              HasSubstr("did you mean 'colour' of the config itself?"));
  EXPECT_THAT(ErrorOf(WithSource(R"("accuracy": {"zebra": 5})")),
              HasSubstr("unknown key 'zebra'; must be 'max_error_px' or 'max_error_levels'"));
  EXPECT_THAT(ErrorOf(WithSource(R"("a/b\n~": 5)")),
              StartsWith(R"(/a~1b\n~0: unknown key 'a/b\n~'; must be 'seed')"));
}

TEST(Config, ValuesOfAWrongKindSayWhatIsRight) {
  const auto tilt_error = [](const std::string& keys) {
    return ErrorOf(WithSource("\"tilt\": {" + keys + "}"));
  };
  EXPECT_EQ(tilt_error(R"("strength_px": -3)"), "/tilt/strength_px: is -3, must be in [0, 64] px");
  EXPECT_EQ(tilt_error(R"("strength_px": "5")"),
            "/tilt/strength_px: is \"5\", must be a number in [0, 64] px");
  EXPECT_EQ(tilt_error(R"("strength_px": null)"),
            "/tilt/strength_px: is null, must be a number in [0, 64] px");
  EXPECT_EQ(tilt_error(R"("octaves": 3.9)"), "/tilt/octaves: is 3.9, must be a whole number in [1, 16]");
  EXPECT_EQ(tilt_error(R"("octaves": 8.0)"),
            "/tilt/octaves: is 8.0, must be a whole number in [1, 16], written without fraction or exponent");
  EXPECT_EQ(tilt_error(R"("octaves": 4294967297)"), "/tilt/octaves: is 4294967297, must be in [1, 16]");
  EXPECT_EQ(tilt_error(R"("octaves": true)"), "/tilt/octaves: is true, must be a whole number in [1, 16]");
  EXPECT_EQ(tilt_error(R"("kernel": 0.55)"), "/tilt/kernel: is 0.55, must be 0.5 or 0.6");
  EXPECT_EQ(tilt_error(R"("lattice": "seed")"),
            R"(/tilt/lattice: is "seed", must be one of "seeded", "classic")");
  EXPECT_EQ(ErrorOf(WithSource(R"("tilt": [])")), "/tilt: is [], must be an object");
  EXPECT_EQ(ErrorOf("[]"), ": is [], must be an object");
  EXPECT_EQ(ErrorOf(R"({"source": {"drawn": "chart", "flip": 1}})"),
            "/source/flip: is 1, must be true or false");
  EXPECT_EQ(ErrorOf(R"({"source": {"drawn": "moon"}})"),
            R"(/source/drawn: is "moon", must be one of "chart", "bricks", "text", "star", "stripes")");
}

TEST(Config, SizesAreTwoWholeNumbers) {
  EXPECT_EQ(Parsed(WithSource(R"("size": [1, 32768])")).fixed().size, cv::Size(1, 32768));
  for (const char* bad : {"5", "[5]", "[5, 5, 5]", "\"5x5\"", "[]"})
    EXPECT_THAT(ErrorOf(WithSource(std::string(R"("size": )") + bad)), HasSubstr("must be [width, height]"))
        << bad;
  EXPECT_EQ(ErrorOf(WithSource(R"("size": [64, 0])")), "/size/1: is 0, must be in [1, 32768] px");
  EXPECT_EQ(ErrorOf(WithSource(R"("size": [64.5, 1])")),
            "/size/0: is 64.5, must be a whole number in [1, 32768] px");
}

TEST(Config, ListsTakeASingleText) {
  const ConfigFile file = Parsed(R"({"source": {"video": "a.mp4"}, "output": {"truth": "sigma"}})");
  EXPECT_EQ(file.resolved()["source"]["video"], Json::array({"a.mp4"}));
  EXPECT_EQ(file.fixed().output.truth, std::vector<std::string>{"sigma"});
  EXPECT_THAT(ErrorOf(R"({"source": {"images": []}})"),
              StartsWith("/source/images: is [], must be a text or a list"));
  EXPECT_THAT(ErrorOf(R"({"source": {"images": ["a", ""]}})"),
              StartsWith("/source/images/1: is \"\", must be"));
  EXPECT_THAT(ErrorOf(R"({"source": {"images": ["a", 3]}})"), StartsWith("/source/images/1: is 3, must be"));
  EXPECT_THAT(ErrorOf(R"({"source": {"images": "a\u0000b"}})"), HasSubstr("without NUL"));
  EXPECT_THAT(ErrorOf(WithSource(R"("output": {"truth": ["tilt", "depth"]})")),
              StartsWith("/output/truth/1: is \"depth\", must be one of \"tilt\", \"sigma\""));
  EXPECT_THAT(ErrorOf(WithSource(R"("output": {"truth": ["tilt", "tilt"]})")),
              StartsWith("/output/truth/1: "));
}

TEST(Config, AListHasAnElementForEach) {
  const ConfigFile file =
      Parsed(WithSource(R"("objects": [{"drawn": "box", "motion": {"speed_px": {"uniform": [1, 3]}}},
                                                         {"images": "cars", "distance": 0.5}])"));
  ASSERT_EQ(file.fixed().objects.size(), 2u);
  EXPECT_EQ(file.fixed().objects[0].drawn, "box");
  EXPECT_EQ(file.fixed().objects[1].images, std::vector<std::string>{"cars"});
  EXPECT_EQ(file.fixed().objects[1].distance, 0.5);
  EXPECT_EQ(file.resolved()["objects"][1]["motion"]["path"], "line");
  EXPECT_EQ(ConfigFile::Parse(file.resolved().dump()).resolved(), file.resolved());
  Json drawn;
  const Config clip = file.Draw(3, &drawn);
  EXPECT_EQ(drawn.at("objects.0.motion.speed_px"), clip.objects[0].motion.speed_px);
  EXPECT_NE(clip.objects[0].motion.speed_px, file.Draw(4, nullptr).objects[0].motion.speed_px);
  EXPECT_EQ(clip.objects[1].motion.speed_px, 2);
}

TEST(Config, OfAListEachElementIsChecked) {
  EXPECT_EQ(ErrorOf(WithSource(R"("objects": [])")), "no error");
  EXPECT_THAT(ErrorOf(WithSource(R"("objects": {})")),
              StartsWith("/objects: is {}, must be a list of at most 64"));
  EXPECT_THAT(ErrorOf(WithSource(R"("objects": [{"drawn": "box"}, 1])")), StartsWith("/objects/1: "));
  EXPECT_THAT(ErrorOf(WithSource(R"("objects": [{"drawn": "box", "motion": {"sped_px": 1}}])")),
              StartsWith("/objects/0/motion/sped_px: unknown key 'sped_px'; did you mean 'speed_px'?"));
  EXPECT_THAT(ErrorOf(WithSource(R"("objects": [{"drawn": "box", "height_px": 0}])")),
              StartsWith("/objects/0/height_px: is 0, must be in [1, 8192] px"));
  EXPECT_THAT(ErrorOf(WithSource(R"("objects": [{"drawn": "box", "images": "a"}])")),
              StartsWith("/objects/0: has 'drawn' and 'images', must have exactly one"));
  EXPECT_THAT(ErrorOf(WithSource(R"("objects": [{}])")), StartsWith("/objects/0: has none of"));
}

TEST(Config, AListIsSetByItsNumber) {
  const std::string text = WithSource(R"("objects": [{"drawn": "box"}, {"drawn": "disc"}])");
  EXPECT_EQ(Parsed(text, {"objects.1.height_px=7"}).fixed().objects[1].height_px, 7);
  EXPECT_EQ(Parsed(text, {"objects.1.motion.path=arc"}).fixed().objects[1].motion.path, sim::PathKind::kArc);
  EXPECT_EQ(Parsed(text, {R"(objects=[{"drawn": "walker"}])"}).fixed().objects.size(), 1u);
  EXPECT_THROW(Parsed(text, {"objects.height_px=7"}), ConfigError);
  EXPECT_THROW(Parsed(text, {"objects.1=7"}), ConfigError);
  EXPECT_THROW(Parsed(text, {"objects.9.height_px=7"}), ConfigError);
}

TEST(Config, PointsArePairsInTheirRange) {
  const auto shifts =
      Parsed(WithSource(R"("frames": 2, "camera": {"shake": "list", "shifts": [[0, 0], [1.5, -2]]})"))
          .fixed()
          .camera.shifts;
  EXPECT_EQ(shifts, (std::vector<cv::Point2d>{{0, 0}, {1.5, -2}}));
  EXPECT_THAT(ErrorOf(WithSource(R"("camera": {"shifts": [[0, 0], [1]]})")),
              StartsWith("/camera/shifts/1: is [1], must be [x, y]"));
  EXPECT_THAT(ErrorOf(WithSource(R"("camera": {"shifts": [[0, 900]]})")),
              StartsWith("/camera/shifts/0/1: is 900, must be in"));
  EXPECT_THAT(ErrorOf(WithSource(R"("camera": {"shifts": 3})")),
              StartsWith("/camera/shifts: is 3, must be a list of [x, y]"));
}

}  // namespace
}  // namespace shimmer::app
