// What `shimmer plan`, `keys` and `schema` print.
#include <functional>

#include "tests/app/program.h"

namespace shimmer::app {
namespace {

class Plans : public testing::Test {
 protected:
  Json PlanOf(const Json& changes = Json::object(), const Words& more = {}) {
    folder_.Put("c.json", SmallConfig(changes));
    Words words = {"plan", "c.json"};
    words.insert(words.end(), more.begin(), more.end());
    const Ran ran = Shimmer(folder_, words);
    ExpectDone(ran);
    return Json::parse(ran.out);
  }

  TempFolder folder_;
};

TEST_F(Plans, ShowWhatIsSkipped) {
  const Json full = PlanOf({{"blur", {{"max_sigma_px", 1}, {"method", "exact"}}}}).at("plan");
  EXPECT_FALSE(full.at("tilt").at("frozen"));
  EXPECT_FALSE(full.at("blur").at("frozen"));
  EXPECT_TRUE(full.at("read_once"));  // a drawn scene is a still
  EXPECT_FALSE(full.at("render_once"));
  EXPECT_FALSE(full.at("linear_light"));
  // Strength 5 and the warp's reach; six sigma, as the exact Gaussian has it.
  EXPECT_EQ(full.at("halo_px"), 5 + 2 + 6);

  EXPECT_TRUE(PlanOf({{"tilt", {{"strength_px", 0}}}}).at("plan").at("tilt").is_null());
  EXPECT_TRUE(PlanOf({{"blur", {{"max_sigma_px", 0}}}}).at("plan").at("blur").is_null());
  EXPECT_TRUE(PlanOf({{"colour", "linear"}}).at("plan").at("linear_light"));
  EXPECT_FALSE(PlanOf({{"source", {{"video", "v.avi"}}}}).at("plan").at("read_once"));
  const Json frozen =
      PlanOf({{"tilt", {{"temporal_scale", 0}}}, {"blur", {{"max_sigma_px", 1}, {"temporal_scale", 0}}}})
          .at("plan");
  EXPECT_TRUE(frozen.at("tilt").at("frozen"));
  EXPECT_TRUE(frozen.at("blur").at("frozen"));
  EXPECT_TRUE(frozen.at("render_once"));
}

// Each thing that is not computed has a line; slow octaves pay for key frames only if enough frames are kept.
TEST_F(Plans, SayWhatIsSkipped) {
  const Json slow = {{"frames", 64},
                     {"size", {128, 96}},
                     {"tilt", {{"kernel", 0.5}, {"temporal_scale", 0.02}, {"octaves", 4}}},
                     {"blur", {{"max_sigma_px", 0}}},
                     {"accuracy", {{"max_error_px", 1}}}};
  const Json all = PlanOf(slow).at("skipped");
  EXPECT_THAT(all.dump(), testing::HasSubstr("all but one frame in"));
  EXPECT_THAT(all.dump(), testing::HasSubstr("blur: blur.max_sigma_px is 0"));
  EXPECT_THAT(all.dump(), testing::HasSubstr("frames before 0 and after 63"));
  Json pairs = slow;
  pairs["output"] = {{"layout", "pairs"}, {"frames_per_clip", 1}};
  const Json one = PlanOf(pairs).at("skipped");
  EXPECT_THAT(one.dump(), testing::Not(testing::HasSubstr("all but one frame in")));
  EXPECT_THAT(one.dump(), testing::HasSubstr("all but 1 of 64 frames"));
  const Json none = PlanOf({{"tilt", {{"strength_px", 0}}}, {"blur", {{"max_sigma_px", 0.2}}}}).at("skipped");
  EXPECT_THAT(none.dump(), testing::HasSubstr("tilt: tilt.strength_px is 0"));
  EXPECT_THAT(none.dump(), testing::HasSubstr("sigma up to 0.2 px can't be seen"));
}

// The plan of a clip is that of its manifest line, with the values that are drawn for it.
TEST_F(Plans, AreTheManifests) {
  const Json config = {{"tilt", {{"strength_px", {{"uniform", {1, 9}}}}}}};
  const Json plan = PlanOf(config, {"--clip", "2"});
  ExpectDone(Generate(folder_, "c.json", "set"));
  const Json line = ManifestLines(folder_ / "set").at(2);
  EXPECT_EQ(plan.at("clip"), 2);
  EXPECT_EQ(plan.at("drawn"), line.at("drawn"));
  EXPECT_EQ(plan.at("plan"), line.at("plan"));
  EXPECT_NE(PlanOf(config).at("drawn"), line.at("drawn"));
}

TEST(Program, PrintsTheSchemaThatShips) {
  const TempFolder folder;
  const Ran ran = Shimmer(folder, {"schema"});
  ExpectDone(ran);
  EXPECT_EQ(ran.out, ReadText(fs::path(SHIMMER_SOURCE_DIR) / "configs/schema.json"));
}

// Paths of all leaves of a resolved config, "tilt.strength_px".
std::vector<std::string> Leaves(const Json& config) {
  std::vector<std::string> leaves;
  for (const auto& [name, value] : config.items()) {
    if (!value.is_object() || value.empty())
      leaves.push_back(name);
    else
      for (const std::string& leaf : Leaves(value)) leaves.push_back(name + "." + leaf);
  }
  return leaves;
}

TEST(Program, ListsEveryKey) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig());
  ExpectDone(Generate(folder, "c.json", "set", {"--clip", "0"}));
  const Ran ran = Shimmer(folder, {"keys"});
  ExpectDone(ran);
  auto keys = Leaves(dataset::DatasetReader(folder / "set").description().at("config"));
  keys.insert(keys.end(), {"source.images", "source.video", "source.sequence"});
  EXPECT_GT(keys.size(), 35u);
  for (const std::string& key : keys) EXPECT_THAT(ran.out, testing::ContainsRegex("(^|\n) *" + key + "[* :]"));
}

TEST(Program, SaysThatItsOutputIsFull) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  for (const char* command : {"keys", "schema"})
    EXPECT_NE(std::system((std::string("'") + SHIMMER_PROGRAM + "' " + command + " >/dev/full 2>&1").c_str()),
              0);
}

}  // namespace
}  // namespace shimmer::app
