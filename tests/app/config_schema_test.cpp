#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "sim/app/config/config.h"
#include "tests/app/config_errors.h"
#include "tests/app/python.h"

namespace shimmer::app {
namespace {

using testing::HasSubstr;

// SHIMMER_WRITE_SCHEMA=1 writes the file anew instead.
TEST(ConfigSchema, FileIsWhatTheFieldsSay) {
  const std::string path = std::string(SHIMMER_SOURCE_DIR) + "/configs/schema.json";
  if (std::getenv("SHIMMER_WRITE_SCHEMA")) std::ofstream(path) << SchemaText();
  std::stringstream file;
  file << std::ifstream(path).rdbuf();
  EXPECT_TRUE(file.str() == SchemaText())
      << path << " is out of date: run this test with SHIMMER_WRITE_SCHEMA=1";
}

// Each bad config is refused by ConfigFile too; "8.0" and rules between keys are ConfigFile's alone.
TEST(ConfigSchema, TellsGoodConfigsFromBad) {
  if (!PythonHas("jsonschema")) GTEST_SKIP() << kPython << " has no jsonschema";
  const std::vector<std::string> good = {
      WithSource(),
      kFullConfig,
      ConfigFile::Parse(WithSource()).resolved().dump(),
      ConfigFile::Parse(kFullConfig).resolved().dump(),
      WithSource(R"("seed": 18446744073709551615, "output": {"truth": "tilt"})"),
      R"({"source": {"drawn": {"choice": ["star", "text"]}}})"};
  const std::vector<std::string> bad = {
      "{}",
      "[]",
      R"({"source": {}})",
      R"({"source": {"drawn": "chart", "images": "a"}})",
      R"({"source": {"images": []}})",
      R"({"source": {"images": ""}})",
      R"({"source": {"drawn": "moon"}})",
      WithSource(R"("seed": -1)"),
      WithSource(R"("seed": 18446744073709551616)"),
      WithSource(R"("frames": 2.5)"),
      WithSource(R"("frames": {"uniform": [1, 2]})"),
      WithSource(R"("size": [1])"),
      WithSource(R"("size": [1, 0])"),
      WithSource(R"("tilt": {"strenght_px": 5})"),
      WithSource(R"("tilt": {"strength_px": 65})"),
      WithSource(R"("tilt": {"strength_px": "5"})"),
      WithSource(R"("tilt": {"strength_px": {}})"),
      WithSource(R"("tilt": {"strength_px": {"uniform": [1, 65]}})"),
      WithSource(R"("tilt": {"strength_px": {"uniform": [1]}})"),
      WithSource(R"("tilt": {"strength_px": {"log_uniform": [0, 1]}})"),
      WithSource(R"("tilt": {"strength_px": {"uniform": [1, 2], "normal": [1, 2]}})"),
      WithSource(R"("tilt": {"strength_px": {"uniform": [1, 2], "weights": [1, 2]}})"),
      WithSource(R"("tilt": {"strength_px": {"unifrom": [1, 2]}})"),
      WithSource(R"("tilt": {"kernel": 0.55})"),
      WithSource(R"("tilt": {"kernel": {"uniform": [0.5, 0.6]}})"),
      WithSource(R"("tilt": {"lattice": {"choice": []}})"),
      WithSource(R"("tilt": {"octaves": {"choice": [1, 2], "weights": [1, -1]}})"),
      WithSource(R"("camera": {"shake_px": 1})"),
      WithSource(R"("objects": [1])"),
      WithSource(R"("output": {"bits": 12})"),
      WithSource(R"("output": {"name": ""})"),
      WithSource(R"("output": {"truth": ["tilt", "tilt"]})"),
      WithSource(R"("output": {"truth": ["depth"]})")};
  for (const std::string& text : good) EXPECT_EQ(ErrorOf(text), "no error");
  for (const std::string& text : bad) EXPECT_NE(ErrorOf(text), "no error") << text;

  std::vector<std::string> texts = {SchemaText()};
  texts.insert(texts.end(), good.begin(), good.end());
  texts.insert(texts.end(), bad.begin(), bad.end());
  const std::string script =
      "import json, sys\n"
      "from jsonschema import Draft202012Validator\n"
      "schema, *configs = [json.load(open(path, encoding='utf-8')) for path in sys.argv[1:]]\n"
      "Draft202012Validator.check_schema(schema)\n"
      "validator = Draft202012Validator(schema)\n"
      "print(''.join('+' if validator.is_valid(config) else '-' for config in configs), end='')\n";
  EXPECT_EQ(RunPython(script, texts), std::string(good.size(), '+') + std::string(bad.size(), '-'));
}

TEST(ConfigHelp, NamesEveryKeyWithDefaultRangeAndMeaning) {
  const std::string help = KeysHelpText();
  const Json resolved = ConfigFile::Parse(WithSource()).resolved();
  for (const auto& [section, value] : resolved.items()) {
    EXPECT_THAT(help, HasSubstr("\n" + section));
    if (!value.is_object()) continue;
    for (const auto& [key, leaf] : value.items()) EXPECT_THAT(help, HasSubstr("  " + section + "." + key));
  }
  EXPECT_THAT(
      help, testing::ContainsRegex("tilt.strength_px\\* +5.0 +a number in \\[0, 64\\] px\n +S: the largest"));
  EXPECT_THAT(help, testing::ContainsRegex("output.frames_per_clip +1 +a whole number in \\[1, 100000\\]\n"));
  EXPECT_THAT(help, HasSubstr("\"log_uniform\""));
  std::stringstream lines(help);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
}

}  // namespace
}  // namespace shimmer::app
