// Wrong arguments and wrong configs: one line that says what is wrong, exit code 2, and nothing touched.
#include "tests/app/program.h"

namespace shimmer::app {
namespace {

struct BadConfig {
  const char *name, *text;
  Words parts;  // of the line
};

class BadConfigs : public testing::TestWithParam<BadConfig> {};

TEST_P(BadConfigs, GiveOneLineAndTouchNothing) {
  const TempFolder folder;
  folder.Put("c.json", std::string(GetParam().text));
  for (const Words& command : {Words{"generate", "c.json", "--out", "set"}, Words{"plan", "c.json"}})
    ExpectOneLine(Shimmer(folder, command), 2, GetParam().parts);
  EXPECT_EQ(NamesIn(folder.path()), std::set<std::string>{"c.json"});
}

INSTANTIATE_TEST_SUITE_P(
    Program, BadConfigs,
    testing::Values(
        BadConfig{"Empty", "", {"c.json: is empty, must be JSON"}},
        BadConfig{"NoJson", "seed: 7", {"c.json"}}, BadConfig{"NoObject", "[1]", {"c.json: "}},
        BadConfig{"CutOff", R"({"source": {"drawn": "chart")", {"c.json: "}},
        BadConfig{"Comment", R"({"seed": 7} // mine)", {"c.json: "}},
        BadConfig{"NoSource", "{}", {"c.json:/source: ", "exactly one"}},
        BadConfig{"TwoSources", R"({"source": {"drawn": "chart", "images": "."}})", {"c.json:/source: "}},
        BadConfig{"UnknownKey",
                  R"({"source": {"drawn": "chart"}, "tilt": {"strenght_px": 5}})",
                  {"c.json:/tilt/strenght_px: unknown key", "did you mean 'strength_px'?"}},
        BadConfig{"OutOfRange",
                  R"({"source": {"drawn": "chart"}, "tilt": {"strength_px": 65}})",
                  {"c.json:/tilt/strength_px: is 65, must be in [0, 64] px"}},
        BadConfig{"DrawnOutOfRange",
                  R"({"source": {"drawn": "chart"}, "blur": {"max_sigma_px": {"uniform": [1, 40]}}})",
                  {"c.json:/blur/max_sigma_px", "[0, 32]"}},
        BadConfig{"DuplicateKey",
                  R"({"source": {"drawn": "chart"}, "seed": 1, "seed": 2})",
                  {"c.json:/seed: key 'seed' is there twice"}},
        BadConfig{"WrongKind",
                  R"({"source": {"drawn": "chart"}, "frames": 2.5})",
                  {"c.json:/frames: ", "whole number"}},
        BadConfig{"SeedTooLarge",
                  R"({"source": {"drawn": "chart"}, "seed": 18446744073709551616})",
                  {"c.json:/seed: "}},
        BadConfig{"UnknownScene", R"({"source": {"drawn": "charts"}})", {"c.json:/source/drawn: "}},
        BadConfig{"BitsOfAnotherFormat",
                  R"({"source": {"drawn": "chart"}, "output": {"bits": 32}})",
                  {"c.json:/output/bits: is 32, must be 8 or 16"}}),
    [](const auto& info) { return info.param.name; });

TEST(ProgramInput, ConfigThatIsNotThere) {
  const TempFolder folder;
  ExpectOneLine(Generate(folder, "no.json", "set"), 2, {"no.json: ", "No such file"});
  ExpectOneLine(Generate(folder, ".", "set"), 2, {"directory"});
  EXPECT_TRUE(NamesIn(folder.path()).empty());
}

TEST(ProgramInput, WrongArguments) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  ExpectOneLine(Shimmer(folder, {}), 2, {"required"});
  ExpectOneLine(Shimmer(folder, {"genrate", "c.json"}), 2, {"unknown command 'genrate'", "'generate'"});
  ExpectOneLine(Shimmer(folder, {"generate"}), 2, {"CONFIG"});
  ExpectOneLine(Shimmer(folder, {"generate", "c.json"}), 2, {"--out is required"});
  ExpectOneLine(Generate(folder, "c.json", ""), 2, {"--out"});
  ExpectOneLine(Generate(folder, "c.json", "set", {"--sed", "7"}), 2, {"--sed"});
  ExpectOneLine(Generate(folder, "c.json", "set", {"another"}), 2, {"another"});
  ExpectOneLine(Generate(folder, "c.json", "set", {"--threads", "0"}), 2, {"--threads"});
  ExpectOneLine(Generate(folder, "c.json", "set", {"--clip", "4"}), 2, {"--clip 4: must be in [0, 3]"});
  ExpectOneLine(Generate(folder, "c.json", "set", {"--clip", "-1"}), 2, {"--clip -1: must be in [0, 3]"});
  ExpectOneLine(Generate(folder, "c.json", "set", {"--set", "seed"}), 2, {"--set seed, must be PATH=VALUE"});
  ExpectOneLine(Generate(folder, "c.json", "set", {"--set", "tilt.strength=5"}), 2,
                {"/tilt/strength: unknown key", "did you mean 'strength_px'?"});
  ExpectOneLine(Shimmer(folder, {"plan", "c.json", "--clip", "4"}), 2, {"--clip 4"});
  ExpectOneLine(Shimmer(folder, {"preview", "no", "--out", "sheet.jpg"}), 2, {"sheet.jpg", ".png", ".gif"});
  EXPECT_EQ(NamesIn(folder.path()), std::set<std::string>{"c.json"});
}

TEST(ProgramInput, SourcePatternThatMatchesNothing) {
  const TempFolder folder;
  for (const char* kind : {"images", "video", "sequence"}) {
    folder.Put("c.json", SmallConfig({{"source", {{kind, "photos/**/*.jpg"}}}}));
    ExpectOneLine(
        Generate(folder, "c.json", "set"), 2,
        {std::string("c.json:/source/") + kind + ": 'photos/**/*.jpg': nothing found", folder.path()});
  }
  EXPECT_EQ(NamesIn(folder.path()), std::set<std::string>{"c.json"});
}

TEST(ProgramInput, HelpAndVersionAreNoErrors) {
  const TempFolder folder;
  for (const Words& words : {Words{"--help"}, Words{"--version"}, Words{"generate", "--help"}}) {
    const Ran ran = Shimmer(folder, words);
    ExpectDone(ran);
    EXPECT_THAT(ran.out, testing::HasSubstr(words.back() == "--version" ? "shimmer 0." : "Usage: "));
  }
}

}  // namespace
}  // namespace shimmer::app
