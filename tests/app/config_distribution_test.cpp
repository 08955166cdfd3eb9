#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/app/config/distribution.h"
#include "tests/app/config_errors.h"

namespace shimmer::app {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string TiltError(const std::string& key, const std::string& distribution) {
  return ErrorOf(WithSource("\"tilt\": {\"" + key + "\": " + distribution + "}"));
}

TEST(Distribution, LiesWithinTheRange) {
  EXPECT_EQ(TiltError("strength_px", R"({"uniform": [0, 64]})"), "no error");
  EXPECT_EQ(TiltError("strength_px", R"({"uniform": [-1, 5]})"),
            "/tilt/strength_px/uniform/0: is -1, must be in [0, 64] px");
  EXPECT_EQ(TiltError("strength_px", R"({"log_uniform": [1, 65]})"),
            "/tilt/strength_px/log_uniform/1: is 65, must be in [0, 64] px");
  EXPECT_EQ(TiltError("strength_px", R"({"normal": [5, 1], "clip": [0, 100]})"),
            "/tilt/strength_px/clip/1: is 100, must be in [0, 64] px");
  EXPECT_EQ(TiltError("strength_px", R"({"choice": [1, 2, -3]})"),
            "/tilt/strength_px/choice/2: is -3, must be in [0, 64] px");
  EXPECT_EQ(TiltError("octaves", R"({"uniform": [1, 8.5]})"),
            "/tilt/octaves/uniform/1: is 8.5, must be a whole number in [1, 16]");
  EXPECT_EQ(TiltError("lattice", R"({"choice": ["seeded", "sown"]})"),
            R"(/tilt/lattice/choice/1: is "sown", must be one of "seeded", "classic")");
  EXPECT_EQ(ErrorOf(WithSource(R"("size": {"choice": [[8, 8], [8, 0]]})")),
            "/size/choice/1/1: is 0, must be in [1, 32768] px");
}

TEST(Distribution, OfAWrongFormIsRefused) {
  const auto error = [](const std::string& distribution) { return TiltError("strength_px", distribution); };
  EXPECT_EQ(error("{}"), "/tilt/strength_px: is {}, must be a number in [0, 64] px, or a distribution");
  EXPECT_THAT(error(R"({"unifrom": [1, 2]})"),
              HasSubstr("/unifrom: unknown key 'unifrom'; did you mean 'uniform'?"));
  EXPECT_THAT(error(R"({"uniform": [1, 2], "choice": [1]})"), HasSubstr("has both 'uniform' and 'choice'"));
  EXPECT_THAT(error(R"({"uniform": [1, 2], "clip": [1, 2]})"),
              StartsWith("/tilt/strength_px/clip: has no meaning"));
  EXPECT_THAT(error(R"({"clip": [1, 2]})"), HasSubstr("or a distribution"));
  EXPECT_THAT(error(R"({"uniform": [2, 1]})"),
              HasSubstr("is [2,1], must be [a, b] with a not greater than b"));
  EXPECT_THAT(error(R"({"uniform": [1]})"), HasSubstr("is [1], must be [a, b]"));
  EXPECT_THAT(error(R"({"uniform": 1})"), HasSubstr("is 1, must be [a, b]"));
  EXPECT_THAT(error(R"({"uniform": [1, {"uniform": [2, 3]}]})"), HasSubstr("/uniform/1: is {"));
  EXPECT_THAT(error(R"({"log_uniform": [0, 1]})"),
              HasSubstr("/log_uniform/0: is 0.0, must be greater than 0"));
  EXPECT_THAT(error(R"({"log_uniform": [1e-310, 1]})"), HasSubstr("must be greater than 0"));
  EXPECT_THAT(error(R"({"normal": [5]})"), HasSubstr("must be [mean, sd]"));
  EXPECT_THAT(error(R"({"normal": [5, -1]})"), HasSubstr("must be [mean, sd], two numbers, sd at least 0"));
  EXPECT_THAT(error(R"({"normal": [5, 1], "clip": [12, 20]})"),
              HasSubstr("must have its mean within 6 sd of the clip"));
  EXPECT_THAT(error(R"({"normal": [5, 0], "clip": [6, 7]})"),
              HasSubstr("must have its mean within 6 sd of the clip"));
  EXPECT_THAT(error(R"({"choice": []})"), HasSubstr("must be a list of at least one value"));
  EXPECT_THAT(error(R"({"choice": [1, 2], "weights": [1]})"),
              HasSubstr("/weights: is [1], must be a list of 2 numbers"));
  EXPECT_THAT(error(R"({"choice": [1, 2], "weights": [1, -1]})"), HasSubstr("/weights/1: is -1, must be"));
  EXPECT_THAT(error(R"({"choice": [1, 2], "weights": [0, 0]})"),
              HasSubstr("must have a finite sum greater than 0"));
  EXPECT_THAT(error(R"({"choice": [1, 2], "weights": [1e308, 1e308]})"), HasSubstr("must have a finite sum"));
}

TEST(Distribution, FitsTheKindOfKey) {
  EXPECT_EQ(TiltError("kernel", R"({"uniform": [0.5, 0.6]})"),
            "/tilt/kernel/uniform: does not fit what is 0.5 or 0.6: must be \"choice\"");
  EXPECT_THAT(TiltError("lattice", R"({"normal": [0, 1]})"),
              StartsWith("/tilt/lattice/normal: does not fit"));
  EXPECT_EQ(ErrorOf(WithSource(R"("frames": {"uniform": [1, 2]})")),
            "/frames: is {\"uniform\":[1,2]}, but holds for the whole data set: must be a whole number in "
            "[1, 1000000] "
            "frames, no distribution");
}

TEST(Distribution, OfAKeyWithoutRangeNeedsItsClip) {
  const Key key{
      .path = "shift", .pointer = "/shift", .field = {.name = "shift", .help = ""}, .kind = Kind::kReal};
  try {
    CheckedDistribution(key, {{"normal", {0, 1}}}, "/shift");
    FAIL() << "no clip, no range, no error";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "needs \"clip\": [a, b], since shift has no range of its own");
  }
}

}  // namespace
}  // namespace shimmer::app
