// Rules between keys, --set, and the form that resolved configs have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "sim/app/config/config.h"
#include "sim/app/config/hash.h"
#include "sim/app/config/json_reader.h"
#include "tests/app/config_errors.h"
#include "tests/app/python.h"

namespace shimmer::app {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string HashOf(const std::string& text, const std::vector<std::string>& sets = {}) {
  return ConfigFile::Parse(text, sets).Hash();
}

TEST(ConfigRules, ExactlyOneSource) {
  EXPECT_EQ(ErrorOf("{}"),
            "/source: has none of 'images', 'video', 'sequence' and 'drawn', must have exactly one");
  EXPECT_THAT(ErrorOf(R"({"source": {"drawn": "chart", "video": "a.mp4"}})"),
              StartsWith("/source: has 'video' and 'drawn', must have exactly one of"));
  for (const char* source : {R"("images": "a")", R"("video": "a")", R"("sequence": ["a"])",
                             R"("drawn": "star")", R"("drawn": {"choice": ["star", "text"]})"})
    EXPECT_EQ(ErrorOf(std::string(R"({"source": {)") + source + "}}"), "no error") << source;
}

TEST(ConfigRules, SigmasAreOrderedWhateverIsDrawn) {
  const auto blur_error = [](const std::string& keys) {
    return ErrorOf(WithSource("\"blur\": {" + keys + "}"));
  };
  EXPECT_EQ(blur_error(R"("min_sigma_px": 3, "max_sigma_px": 3)"), "no error");
  EXPECT_EQ(blur_error(R"("min_sigma_px": 3.1)"),
            "/blur/min_sigma_px: is 3.1, must never exceed blur.max_sigma_px, which is 3.0");
  EXPECT_EQ(blur_error(R"("min_sigma_px": {"uniform": [0, 1]}, "max_sigma_px": {"log_uniform": [1, 2]})"),
            "no error");
  EXPECT_THAT(blur_error(R"("min_sigma_px": {"uniform": [0, 1.1]}, "max_sigma_px": {"log_uniform": [1, 2]})"),
              StartsWith("/blur/min_sigma_px: "));
  EXPECT_THAT(
      blur_error(R"("min_sigma_px": {"choice": [0, 2]}, "max_sigma_px": {"normal": [3, 1], "clip": [1, 4]})"),
      StartsWith("/blur/min_sigma_px: "));
  EXPECT_THAT(blur_error(R"("min_sigma_px": 1, "max_sigma_px": {"choice": [4, 0.5]})"),
              StartsWith("/blur/min_sigma_px: "));
}

TEST(ConfigRules, SidesAreThoseThatH264Knows) {
  const auto error_of = [](const std::string& size, const std::string& compression) {
    return ErrorOf(WithSource("\"size\": " + size + R"(, "sensor": {"compression": )" + compression + "}"));
  };
  EXPECT_EQ(error_of("[16384, 16]", R"("h264")"), "no error");
  EXPECT_EQ(error_of("[16385, 16]", R"("h264")"),
            "/size: is up to 16385x16, must be at most 16384 px each way where sensor.compression is h264");
  EXPECT_THAT(error_of(R"({"choice": [[64, 64], [16, 16385]]})", R"({"choice": ["none", "h264"]})"),
              StartsWith("/size: is up to 64x16385, "));
  EXPECT_EQ(error_of("[16385, 16]", R"({"choice": ["none", "jpeg"]})"), "no error");
}

TEST(ConfigRules, BitsFitTheFormat) {
  const auto bits = [](const std::string& output) {
    return ConfigFile::Parse(WithSource("\"output\": {" + output + "}")).resolved()["output"]["bits"];
  };
  EXPECT_EQ(bits(R"("format": "png")"), 8);
  EXPECT_EQ(bits(R"("format": "png", "bits": 16)"), 16);
  EXPECT_EQ(bits(R"("format": "exr")"), 16);
  EXPECT_EQ(bits(R"("format": "exr", "bits": 32)"), 32);
  EXPECT_EQ(ErrorOf(WithSource(R"("output": {"format": "exr", "bits": 8})")),
            "/output/bits: is 8, must be 16 or 32 where output.format is exr");
  EXPECT_EQ(ErrorOf(WithSource(R"("output": {"bits": 32})")),
            "/output/bits: is 32, must be 8 or 16 where output.format is png");
  EXPECT_EQ(ErrorOf(WithSource(R"("output": {"bits": 12})")), "/output/bits: is 12, must be 8 or 16 or 32");
}

TEST(ConfigRules, FramesStayWithinTimeAndClip) {
  EXPECT_EQ(ErrorOf(WithSource(R"("frames": 8, "first_frame": 2147483640)")), "no error");
  EXPECT_EQ(ErrorOf(WithSource(R"("frames": 9, "first_frame": 2147483640)")),
            "/first_frame: is 2147483640, must be at most 2147483639 for frames = 9");
  EXPECT_EQ(ErrorOf(WithSource(R"("frames": 3, "output": {"frames_per_clip": 4})")),
            "/output/frames_per_clip: is 4, must be at most frames = 3");
}

TEST(ConfigRules, NameIsAPlainFolder) {
  for (const char* bad : {"a/b", ".", "..", ".hidden", "-rf", "/abs", "a\\u0007b", "a\\nb", "\\u007f"})
    EXPECT_THAT(ErrorOf(WithSource(std::string(R"("output": {"name": ")") + bad + "\"}")),
                HasSubstr("must be the plain name of a folder"))
        << bad;
  EXPECT_THAT(ErrorOf(WithSource(R"("output": {"name": ""})")),
              HasSubstr("must be a text of 1 to 100 bytes"));
  EXPECT_EQ(ErrorOf(WithSource(R"("output": {"name": "Nächte v1.0"})")), "no error");
}

TEST(ConfigSets, OverrideAnyKey) {
  const ConfigFile file = ConfigFile::Parse(
      WithSource(R"("tilt": {"octaves": 3})"),
      std::vector<std::string>{"tilt.octaves=4", "tilt.octaves=5", "seed=9", "size=[7, 5]", "output.name=a=b",
                               "output.truth=tilt", R"(blur.max_sigma_px={"uniform": [1, 2]})",
                               "tilt.lattice=classic"});
  EXPECT_EQ(file.fixed().tilt.octaves, 5);
  EXPECT_EQ(file.fixed().seed, 9u);
  EXPECT_EQ(file.fixed().size, cv::Size(7, 5));
  EXPECT_EQ(file.fixed().output.name, "a=b");
  EXPECT_EQ(file.fixed().output.truth, std::vector<std::string>{"tilt"});
  EXPECT_EQ(file.fixed().tilt.lattice, sim::LatticeKind::kClassic);
  EXPECT_EQ(file.resolved()["blur"]["max_sigma_px"], (Json{{"uniform", {1.0, 2.0}}}));
}

TEST(ConfigSets, NullTakesAKeyAway) {
  const std::string images = R"({"source": {"images": "a"}})";
  EXPECT_THAT(ErrorOf(images, {"source.drawn=chart"}),
              StartsWith("/source: has 'images' and 'drawn', must have exactly"));
  EXPECT_EQ(ErrorOf(images, {"source.drawn=chart", "source.images=null"}), "no error");
  EXPECT_EQ(ErrorOf(WithSource(), {"source.video=null", "tilt.octaves=null"}), "no error");
}

TEST(ConfigSets, ErrorsPointToTheKey) {
  EXPECT_EQ(ErrorOf(WithSource(), {"tilt.strenght_px=5"}),
            "/tilt/strenght_px: unknown key 'strenght_px'; did you mean 'strength_px'?");
  EXPECT_EQ(ErrorOf(WithSource(), {"tlt.strength_px=5"}), "/tlt: unknown key 'tlt'; did you mean 'tilt'?");
  EXPECT_EQ(ErrorOf(WithSource(), {"tilt.strength_px=-1"}),
            "/tilt/strength_px: is -1, must be in [0, 64] px");
  EXPECT_EQ(ErrorOf(WithSource(), {"tilt.strength_px=much"}),
            "/tilt/strength_px: is \"much\", must be a number in [0, 64] px");
  EXPECT_THAT(ErrorOf(WithSource(), {"tilt=5"}), StartsWith("/tilt: is a section; set one of its keys"));
  EXPECT_THAT(ErrorOf(WithSource(), {"seed.x=5"}),
              StartsWith("/seed/x: unknown key 'x'; seed is set as a whole"));
  EXPECT_THAT(ErrorOf(WithSource(), {"tilt.=5"}), StartsWith("/tilt/: unknown key ''"));
  EXPECT_THAT(ErrorOf(WithSource(), {"=5"}), StartsWith("/: unknown key ''"));
  EXPECT_THAT(ErrorOf(WithSource(), {"tilt.octaves"}),
              StartsWith(": --set tilt.octaves, must be PATH=VALUE"));
  EXPECT_EQ(ErrorOf(WithSource(), {R"(tilt.octaves={"uniform":[1,2],"uniform":[3,4]})"}),
            "/tilt/octaves/uniform: key 'uniform' is there twice; must be there once");
  EXPECT_THAT(ErrorOf(WithSource(), {"seed=18446744073709551616"}),
              StartsWith("/seed: is 18446744073709551616, "));
  EXPECT_THAT(ErrorOf(WithSource(), {"output.name=\xff"}), HasSubstr("must be UTF-8 text"));
  EXPECT_EQ(ErrorOf(R"({"source": 5})", {"source.drawn=chart"}), "/source: is 5, must be an object");
}

TEST(ResolvedConfig, IsTheSameWhenReadAgain) {
  for (const std::string& text :
       {WithSource(), WithSource(R"("output": {"format": "exr"})"), std::string(kFullConfig)}) {
    const ConfigFile once = ConfigFile::Parse(text), twice = ConfigFile::Parse(once.resolved().dump(2));
    EXPECT_EQ(once.resolved().dump(), twice.resolved().dump());
    EXPECT_EQ(once.Hash(), twice.Hash());
  }
}

TEST(ResolvedConfig, SpellingDoesNotMatter) {
  const std::string plain = HashOf(WithSource(R"("tilt": {"strength_px": 5, "octaves": 8})"));
  EXPECT_EQ(plain, HashOf(WithSource(R"("tilt": {"octaves": 8, "strength_px": 5.0})")));
  EXPECT_EQ(plain, HashOf(WithSource(R"("tilt": {"strength_px": 0.5e1}, "camera": {})")));
  EXPECT_EQ(plain, HashOf(WithSource(R"("clips": 77)")));  // the same data set, longer
  EXPECT_EQ(plain, HashOf(WithSource(), {"blur.min_sigma_px=-0.0"}));
  EXPECT_NE(plain, HashOf(WithSource(R"("seed": 1)")));
  EXPECT_NE(plain, HashOf(WithSource(R"("tilt": {"strength_px": 5.000000000000001})")));
  EXPECT_EQ(HashOf(WithSource(R"("tilt": {"octaves": {"choice": [3, 4]}})")),
            HashOf(WithSource(R"("tilt": {"octaves": {"choice": [3, 4], "weights": [1, 1]}})")));
  EXPECT_EQ(HashOf(WithSource(R"("tilt": {"strength_px": {"normal": [5, 1]}})")),
            HashOf(WithSource(R"("tilt": {"strength_px": {"normal": [5.0, 1], "clip": [0, 64]}})")));
}

TEST(ResolvedConfig, CanonicalTextHasShortestNumbers) {
  const Json numbers = ReadJson(
      R"([5.0, 0.1, 1e-4, 1e-5, 1e-06, 1e15, 1e16, 123456789012345680.0, 5e-324, 1.7976931348623157e308, -0.25, 7, -7,
          18446744073709551615, 9007199254740993])");
  EXPECT_EQ(CanonicalText(numbers),
            "[5.0,0.1,0.0001,1e-05,1e-06,1000000000000000.0,1e+16,1.2345678901234568e+17,5e-324,"
            "1.7976931348623157e+308,-0.25,7,-7,18446744073709551615,9007199254740993]");
  EXPECT_EQ(CanonicalText(ReadJson(R"({"b": [], "a": {"é": "\u007f\n", "\"": null}, "": [true, false]})")),
            R"({"":[true,false],"a":{"\"":null,"\u00e9":"\u007f\n"},"b":[]})");
}

TEST(ResolvedConfig, PythonFindsTheSameHash) {
  if (!PythonHas("hashlib")) GTEST_SKIP() << kPython << " is not there";
  const ConfigFile file = ConfigFile::Parse(
      kFullConfig, std::vector<std::string>{"output.name=Nächte", "tilt.base_frequency=1e-6"});
  const std::string script =
      "import hashlib, json, sys\n"
      "config = json.load(open(sys.argv[1], encoding='utf-8'))\n"
      "del config['clips']\n"
      "text = json.dumps(config, sort_keys=True, separators=(',', ':'))\n"
      "print(hashlib.sha256(text.encode()).hexdigest())\n";
  EXPECT_EQ(RunPython(script, {file.resolved().dump(2)}), file.Hash() + "\n");
}

}  // namespace
}  // namespace shimmer::app
