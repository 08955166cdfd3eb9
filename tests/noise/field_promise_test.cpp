// A promise is a bound: random sums of octaves, areas, frames and budgets, against full evaluation.
#include <gtest/gtest.h>

#include <map>

#include "tests/noise/planned_cases.h"

namespace shimmer::noise {
namespace {

TEST(FieldPromise, IsNeverExceeded) {
  std::map<std::string, int> ways;
  for (uint64_t seed = 0; seed < 600; ++seed) {
    const Case c = RandomCase(seed);
    const std::vector<Octave> octaves = OctavesOf(c, seed);
    const FieldPlan plan = PlanOctaves(octaves, c.kind, c.area.width, c.area.height, c.frames, c.budget);
    EXPECT_LE(plan.max_error, c.budget.max);
    EXPECT_LE(plan.rms_error, c.budget.rms);
    for (const OctaveWay& way : plan.octaves) {
      ++ways[NameOf(way)];
      if (way.key_frames > 1) ++ways["key frames"];
    }
    WithOctaves(c.kind, octaves, [&](const auto& sum) {
      const PlannedOctaves planned(sum, plan, c.area);
      const Values got = Render(planned.At(c.t), c.area), full = RenderFull(sum, c.area, c.t);
      // Both are float32 sums of octaves, each within 5e-6 of its amplitude of the truth
      const double rounding = 1e-5 * c.params.peak;
      double max = 0, squares = 0;
      for (size_t i = 0; i < got.size(); ++i) {
        const double error = std::abs(got[i] - full[i]);
        ASSERT_TRUE(std::isfinite(error)) << seed;
        squares += error * error;
        const auto y = static_cast<int64_t>(i) / c.area.width, x = static_cast<int64_t>(i) % c.area.width;
        const bool exempt = error > plan.max_error + rounding &&
                            OnFace(octaves, c.kind, plan, c.t, c.area.y0 + y, c.area.x0 + x);
        if (!exempt) max = std::max(max, error);
      }
      EXPECT_LE(max, plan.max_error + rounding) << "case " << seed << ": " << Describe(plan);
      EXPECT_LE(std::sqrt(squares / static_cast<double>(got.size())), plan.rms_error + rounding)
          << "case " << seed << ": " << Describe(plan);
    });
  }
  for (const char* way : {"full", "dropped", "tile64", "tile128", "grid1", "grid2", "grid4", "grid8",
                          "grid16", "grid32", "grid64", "key frames"})
    EXPECT_GT(ways[way], 0) << way;
}

// Twice the parameters of one plan are one plan; and more budget never costs more error than it has.
TEST(FieldPromise, IsAFunctionOfTheParametersAlone) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    Case c = RandomCase(seed);
    const auto plan = [&](uint64_t lattice_seed) {
      return PlanOctaves(OctavesOf(c, lattice_seed), c.kind, c.area.width, c.area.height, c.frames, c.budget);
    };
    const FieldPlan one = plan(1);
    EXPECT_EQ(one, plan(2));
    c.classic = !c.classic;
    EXPECT_EQ(one, plan(1));
  }
}

TEST(FieldPromise, BadInputIsRefused) {
  const auto octaves = SeededOctaves({}, 0, 0, "a");
  const ErrorBudget budget{.max = 0.1};
  EXPECT_THROW(PlanOctaves(octaves, NoiseKind::kPerlin, 0, 5, 1, budget), std::invalid_argument);
  EXPECT_THROW(PlanOctaves(octaves, NoiseKind::kPerlin, 5, 5, 0, budget), std::invalid_argument);
  EXPECT_THROW(PlanOctaves(octaves, NoiseKind::kPerlin, 5, 5, 1, {.max = -1}), std::invalid_argument);
  EXPECT_THROW(PlanOctaves(octaves, NoiseKind::kPerlin, 5, 5, 1, {.rms = std::nan("")}),
               std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::noise
