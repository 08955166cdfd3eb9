#include "sim/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/error_budget.h"

namespace shimmer::sim {
namespace {

const ClipShape kShape{.size = {64, 48}, .frames = 4};

TEST(PlanClip, SkipsWhatASceneDoesNotNeed) {
  Scene scene;
  EXPECT_TRUE(PlanClip(scene, kShape, {}).tilt);
  EXPECT_TRUE(PlanClip(scene, kShape, {}).blur);
  EXPECT_TRUE(PlanClip(scene, kShape, {}).read_once);
  EXPECT_FALSE(PlanClip(scene, kShape, {}).render_once);

  Scene no_tilt = scene;
  no_tilt.tilt.strength_px = 0;
  EXPECT_FALSE(PlanClip(no_tilt, kShape, {}).tilt);
  EXPECT_FALSE(PlanClip(no_tilt, kShape, {}).blur->tilt);  // tilt01 is 0 where S is 0

  Scene no_blur = scene;
  no_blur.blur.max_sigma_px = 0;
  EXPECT_FALSE(PlanClip(no_blur, kShape, {}).blur);

  Scene nothing = no_tilt;
  nothing.blur.max_sigma_px = 0;
  EXPECT_EQ(PlanClip(nothing, kShape, {}).halo_px, 0);
  EXPECT_TRUE(PlanClip(nothing, kShape, {}).render_once);

  Scene video = nothing;
  video.still = false;
  EXPECT_FALSE(PlanClip(video, kShape, {}).read_once);
  EXPECT_FALSE(PlanClip(video, kShape, {}).render_once);
}

TEST(PlanClip, FreezesWhatStandsStill) {
  Scene scene;
  scene.tilt.temporal_scale = 0;
  EXPECT_TRUE(PlanClip(scene, kShape, {}).tilt->frozen);
  EXPECT_FALSE(PlanClip(scene, kShape, {}).blur->frozen);  // its noise moves
  EXPECT_FALSE(PlanClip(scene, kShape, {}).render_once);
  scene.blur.temporal_scale = 0;
  EXPECT_TRUE(PlanClip(scene, kShape, {}).blur->frozen);
  EXPECT_TRUE(PlanClip(scene, kShape, {}).render_once);
  scene.tilt.temporal_scale = 1;  // and now the tilt moves, and sigma with it
  EXPECT_FALSE(PlanClip(scene, kShape, {}).blur->frozen);
  scene.blur.tilt_weight = 0;
  EXPECT_TRUE(PlanClip(scene, kShape, {}).blur->frozen);
}

TEST(PlanClip, NeedsOnlyThePartsOfTheSigmaMapThatCount) {
  Scene scene;
  scene.blur.tilt_weight = 1;
  EXPECT_FALSE(PlanClip(scene, kShape, {}).blur->noise);
  EXPECT_TRUE(PlanClip(scene, kShape, {}).blur->tilt);
  scene.blur.tilt_weight = 0;
  EXPECT_TRUE(PlanClip(scene, kShape, {}).blur->noise);
  EXPECT_FALSE(PlanClip(scene, kShape, {}).blur->tilt);
  scene.blur.min_sigma_px = scene.blur.max_sigma_px;
  EXPECT_TRUE(PlanClip(scene, kShape, {}).blur->constant);
}

// The budget decides: exact where less than a ladder's error is allowed, and where the config says so.
TEST(PlanClip, ChoosesTheBlurWithinTheBudget) {
  Scene scene;
  const auto blur = [&](double max_error_levels) {
    return *PlanClip(scene, kShape, {.max_error_levels = max_error_levels}).blur;
  };
  const auto is_ladder = [](const BlurPlan& plan, LadderGrade grade) {
    return plan.way == BlurWay::kLadder && plan.grade == grade;
  };
  EXPECT_EQ(blur(0).way, BlurWay::kExact);
  EXPECT_EQ(blur(0.02).way, BlurWay::kExact);
  EXPECT_TRUE(is_ladder(blur(0.05), LadderGrade::kFine));
  EXPECT_TRUE(is_ladder(blur(0.1), LadderGrade::kStandard));
  EXPECT_TRUE(is_ladder(blur(255), LadderGrade::kCoarse));
  scene.colour = Colour::kLinear;  // encoding makes more of errors in the dark
  EXPECT_EQ(blur(0.05).way, BlurWay::kExact);
  EXPECT_TRUE(is_ladder(blur(0.15), LadderGrade::kFine));
  EXPECT_TRUE(is_ladder(blur(0.25), LadderGrade::kStandard));
  for (double levels : {0.05, 0.1, 0.5}) {
    scene.blur.method = BlurMethod::kExact;
    EXPECT_EQ(blur(levels).way, BlurWay::kExact);
    scene.blur.method = BlurMethod::kStack;
    EXPECT_EQ(blur(levels).way, BlurWay::kStack);
  }
}

// Fields spend no more than what they are given: the tilt its pixels, and what the sigma map leaves it.
TEST(PlanClip, FieldsStayWithinTheirShares) {
  Scene scene;
  scene.tilt.base_frequency = scene.blur.base_frequency = 1.0 / 64;
  scene.blur.max_sigma_px = 8;
  const ClipShape shape{.size = {1920, 1080}, .frames = 16};
  for (double px : {0.0, 0.001, 0.01, 0.05, 0.3})
    for (double levels : {0.0, 0.05, 0.1, 0.2, 1.0}) {
      const ClipPlan plan = PlanClip(scene, shape, {.max_error_px = px, .max_error_levels = levels});
      EXPECT_LE(plan.tilt->field.max_error, px);
      const double sigma = std::hypot(plan.tilt->field.rms_error * LevelsPerTiltPx(scene, shape.size),
                                      plan.blur->field.rms_error * LevelsPerNoise(scene.blur, shape.size));
      const double ladder = plan.blur->way == BlurWay::kLadder ? PromiseOf(plan.blur->grade).levels : 0;
      EXPECT_NEAR(std::hypot(ladder, sigma), plan.blur->promised_levels, 1e-9);
      EXPECT_LE(plan.blur->promised_levels, levels * (1 + 1e-9)) << px;
    }
  // A frame that sees little of the map may have the worst of it everywhere.
  EXPECT_GT(LevelsPerNoise(scene.blur, {64, 64}), LevelsPerNoise(scene.blur, shape.size));
  EXPECT_GT(LevelsPerTiltPx(scene, {64, 64}), LevelsPerTiltPx(scene, shape.size));
  // Where sigma does not depend on the tilt, the tilt may err as much as its own budget allows.
  scene.blur.tilt_weight = 0;
  EXPECT_GT(PlanClip(scene, shape, {.max_error_px = 0.3, .max_error_levels = 0}).tilt->field.max_error, 0.05);
}

// A sigma that nobody can see is none: by the budget, and at the exact one by a float's last bit.
TEST(PlanClip, LeavesOutWhatCannotBeSeen) {
  Scene scene;
  const auto blurs = [&](double sigma_px, double max_error_levels) {
    scene.blur.max_sigma_px = sigma_px;
    return PlanClip(scene, kShape, {.max_error_levels = max_error_levels}).blur.has_value();
  };
  EXPECT_FALSE(blurs(0.15, 0));
  EXPECT_TRUE(blurs(0.17, 0));
  EXPECT_FALSE(blurs(0.25, 0.2));
  EXPECT_TRUE(blurs(0.35, 0.2));
  EXPECT_TRUE(blurs(0.6, 255));
  scene.blur.method = BlurMethod::kExact;  // as it says
  EXPECT_TRUE(blurs(0.25, 0.2));
  EXPECT_FALSE(blurs(0.15, 0.2));
}

TEST(PlanClip, MarginsHoldEveryRead) {
  Scene scene;
  scene.tilt.strength_px = 4.5, scene.blur.max_sigma_px = 3;
  scene.blur.method = BlurMethod::kExact;
  const ClipPlan plan = PlanClip(scene, kShape, {});
  EXPECT_EQ(plan.tilt->margin_px, 7);
  EXPECT_EQ(plan.blur->margin_px, 18);
  EXPECT_EQ(plan.halo_px, 25);
  scene.tilt.kernel = 0.5;  // |n| reaches 1.084: 4.88 px
  scene.tilt.strength_px = 5;
  EXPECT_EQ(PlanClip(scene, kShape, {}).tilt->margin_px, 8);
}

TEST(PlanClip, IsAValue) {
  EXPECT_EQ(PlanClip({}, kShape, {}), PlanClip({}, kShape, {}));
  Scene other;
  other.tilt.strength_px = 9;
  EXPECT_NE(PlanClip(other, kShape, {}), PlanClip({}, kShape, {}));
}

template <class Change>
std::string WhatIsWrong(const Change& change) {
  Scene scene;
  ClipShape shape = kShape;
  Accuracy accuracy;
  change(scene, shape, accuracy);
  try {
    PlanClip(scene, shape, accuracy);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing";
}

TEST(PlanClip, NamesTheFieldThatIsOutOfRange) {
  EXPECT_EQ(WhatIsWrong([](Scene& s, ClipShape&, Accuracy&) { s.tilt.strength_px = -3; }),
            "tilt.strength_px = -3, must be in [0, 64] px");
  EXPECT_EQ(WhatIsWrong([](Scene& s, ClipShape&, Accuracy&) { s.tilt.kernel = 0.55; }),
            "tilt.kernel = 0.55, must be 0.5 or 0.6");
  EXPECT_EQ(WhatIsWrong([](Scene& s, ClipShape&, Accuracy&) { s.blur.octaves = 17; }),
            "blur.octaves = 17, must be in [1, 16]");
  EXPECT_EQ(WhatIsWrong([](Scene& s, ClipShape&, Accuracy&) { s.blur.min_sigma_px = 4; }),
            "blur.min_sigma_px = 4, must be in [0, 3] px");
  EXPECT_NE(WhatIsWrong([](Scene& s, ClipShape&, Accuracy&) {
              s.tilt.base_frequency = std::numeric_limits<double>::quiet_NaN();
            }),
            "nothing");
  EXPECT_NE(WhatIsWrong([](Scene&, ClipShape& s, Accuracy&) { s.size.width = 0; }), "nothing");
  EXPECT_NE(WhatIsWrong([](Scene&, ClipShape& s, Accuracy&) { s.first_frame = int64_t{1} << 31; }),
            "nothing");
  EXPECT_NE(WhatIsWrong([](Scene&, ClipShape&, Accuracy& a) { a.max_error_px = -1; }), "nothing");
}

}  // namespace
}  // namespace shimmer::sim
