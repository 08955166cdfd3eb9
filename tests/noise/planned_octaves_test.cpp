// Bits of planned evaluation: those of full evaluation where nothing is lost, and the same in any order, on
// any thread, on any SIMD target, of any crop.
#include "noise/planned_octaves.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <thread>

#include "tests/noise/planned_cases.h"

namespace shimmer::noise {
namespace {

OctaveWay Grid(int spacing_px, int key_frames = 1) {
  return {.kind = OctaveWayKind::kGrid, .spacing_px = spacing_px, .key_frames = key_frames};
}

// Every way at once; the octaves' steps are those of f = 1/64.
FieldPlan EveryWay() {
  return {.octaves = {Grid(8, 4),
                      Grid(2),
                      Grid(1, 2),
                      {},
                      Grid(4, 4),
                      {.kind = OctaveWayKind::kTiled, .period_px = 512},
                      {.kind = OctaveWayKind::kTiled, .period_px = 256},
                      {.kind = OctaveWayKind::kDropped}}};
}

const OctaveParams kParams{.octaves = 8, .base_frequency = 1.0 / 64, .temporal_scale = 1.3, .peak = 5};

TEST(PlannedOctaves, BudgetZeroIsFullEvaluation) {
  int tiles = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    Case c = RandomCase(seed);
    c.budget = {.max = 0};
    const std::vector<Octave> octaves = OctavesOf(c, seed);
    const FieldPlan plan = PlanOctaves(octaves, c.kind, c.area.width, c.area.height, c.frames, c.budget);
    EXPECT_EQ(plan.max_error, 0);
    for (const OctaveWay& way : plan.octaves) tiles += way.kind == OctaveWayKind::kTiled;
    WithOctaves(c.kind, octaves, [&](const auto& sum) {
      const PlannedOctaves planned(sum, plan, c.area);
      EXPECT_EQ(Render(planned.At(c.t), c.area), RenderFull(sum, c.area, c.t))
          << "case " << seed << ": " << Describe(plan);
    });
  }
  EXPECT_GT(tiles, 0);
}

// Tiles wrap to the right and downwards, and begin anywhere.
TEST(PlannedOctaves, TilesRepeatExactly) {
  for (const NoiseKind kind : {NoiseKind::kSimplex06, NoiseKind::kPerlin})
    for (const double step : {4.0, 12.0, 1.0, 0.5}) {
      const auto octaves = SeededOctaves({.octaves = 1, .base_frequency = step}, 3, 0, "a");
      const int period = PeriodPx(octaves[0].step_px).value();
      const FieldPlan plan{.octaves = {{.kind = OctaveWayKind::kTiled, .period_px = period}}};
      for (const PixelArea& area :
           {PixelArea{0, 0, 3 * period + 65, 3 * period + 1},
            PixelArea{-period - 7, -5 * period - 3, 100, 2 * period + 5}, PixelArea{1, 2, 3, 4}})
        WithOctaves(kind, octaves, [&](const auto& sum) {
          const PlannedOctaves planned(sum, plan, area);
          EXPECT_EQ(Render(planned.At(9), area), RenderFull(sum, area, 9)) << step << " " << area.x0;
        });
    }
}

// Periods that divide one another, that don't, and a full octave between: full evaluation's bits all the
// same.
TEST(PlannedOctaves, TilesThatShareAreTheSameSum) {
  constexpr OctaveWay kFull{};
  const auto tile = [](int period_px) {
    return OctaveWay{.kind = OctaveWayKind::kTiled, .period_px = period_px};
  };
  for (const NoiseKind kind : {NoiseKind::kSimplex05, NoiseKind::kPerlin}) {
    const auto octaves = SeededOctaves({.octaves = 6, .base_frequency = 1}, 4, 0, "a");
    const std::vector<FieldPlan> plans{
        {.octaves = {tile(256), tile(128), tile(64), kFull, kFull, kFull}},
        {.octaves = {tile(256), tile(128), tile(64), tile(64), tile(64), kFull}},
        {.octaves = {tile(256), kFull, tile(64), tile(64), tile(64), tile(64)}},
        {.octaves = {tile(256), tile(128), tile(64), tile(64), tile(64), tile(64)}}};
    const PixelArea area{-900, -77, 1000, 601};
    WithOctaves(kind, octaves, [&](const auto& sum) {
      for (const FieldPlan& plan : plans)
        EXPECT_EQ(Render(PlannedOctaves(sum, plan, area).At(9), area), RenderFull(sum, area, 9))
            << Describe(plan);
    });
  }
}

TEST(PlannedOctaves, PeriodsAreExact) {
  EXPECT_EQ(PeriodPx(Fixed::FromDouble(0.5)), 512);
  EXPECT_EQ(PeriodPx(Fixed::FromDouble(64)), 64);
  EXPECT_EQ(PeriodPx(Fixed::FromDouble(1.0 / 8)), std::nullopt);  // 2048
  EXPECT_EQ(PeriodPx(Fixed::FromDouble(0.03 * 32)), std::nullopt);
  EXPECT_EQ(PeriodPx(Fixed::FromBits((int128{1} << 63) + 1)), std::nullopt);
}

TEST(PlannedOctaves, ACropsBitsAreTheAreas) {
  const PixelArea area{-37, 1000001, 301, 211};
  for (const NoiseKind kind : {NoiseKind::kSimplex06, NoiseKind::kPerlin})
    WithOctaves(kind, SeededOctaves(kParams, 1, 0, "a"), [&](const auto& sum) {
      const Values all = Render(PlannedOctaves(sum, EveryWay(), area).At(5), area);
      for (const PixelArea& crop : {PixelArea{-37, 1000001, 1, 1}, PixelArea{0, 1000003, 64, 9},
                                    PixelArea{11, 1000100, 253, 112}, PixelArea{-36, 1000002, 33, 17}}) {
        const Values part = Render(PlannedOctaves(sum, EveryWay(), crop).At(5), crop);
        for (int y = 0; y < crop.height; ++y)
          for (int x = 0; x < crop.width; ++x)
            ASSERT_EQ(part[y * crop.width + x],
                      all[(crop.y0 - area.y0 + y) * area.width + (crop.x0 - area.x0 + x)])
                << crop.x0 << " " << x << " " << y;
      }
    });
}

TEST(PlannedOctaves, ARowMayBeReadInParts) {
  const PixelArea area{-37, 5, 1301, 3};
  const PlannedOctaves planned(SimplexOctaves(SeededOctaves(kParams, 1, 0, "a"), kSimplexKernel06),
                               EveryWay(), area);
  const auto frame = planned.At(2);
  const Values all = Render(frame, area);
  for (const int64_t start : {-37, -36, 0, 63, 500, 1263})
    for (const size_t count : {0, 1, 2, 511, 512, 513, 700}) {
      if (start + static_cast<int64_t>(count) > area.x0 + area.width) continue;
      Values part(count);
      frame.Row(6, start, part);
      for (size_t i = 0; i < count; ++i) ASSERT_EQ(part[i], all[area.width + start - area.x0 + i]) << start;
    }
}

TEST(PlannedOctaves, AnyOrderOfFramesOnAnyThreadIsTheSame) {
  const PixelArea area{3, -9, 97, 51};
  const SimplexOctaves sum(SeededOctaves(kParams, 1, 0, "a"), kSimplexKernel05);
  std::vector<Values> expected;
  constexpr int kFrames = 23;
  for (int t = 0; t < kFrames; ++t)
    expected.push_back(Render(PlannedOctaves(sum, EveryWay(), area).At(t - 11), area));

  const PlannedOctaves planned(sum, EveryWay(), area);
  std::vector<std::vector<Values>> got(3, std::vector<Values>(kFrames));
  std::vector<std::thread> threads;
  for (int k = 0; k < 3; ++k)
    threads.emplace_back([&, k] {
      for (int i = 0; i < kFrames; ++i) {
        const int t = (i * (5 + 2 * k) + 3 * k) % kFrames;  // 5, 7 and 9 have no factor in common with 23
        got[k][t] = Render(planned.At(t - 11), area);
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const auto& frames : got) EXPECT_EQ(frames, expected);
}

TEST(PlannedOctaves, AreTheSameOnEveryTarget) {
  const PixelArea area{-5, 7, 147, 23};
  for (const NoiseKind kind : {NoiseKind::kSimplex06, NoiseKind::kPerlin})
    WithOctaves(kind, SeededOctaves(kParams, 1, 0, "a"), [&](const auto& sum) {
      Values first;
      int targets = 0;
      for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        const Values got = Render(PlannedOctaves(sum, EveryWay(), area).At(3), area);
        if (targets++ == 0) first = got;
        EXPECT_EQ(got, first) << hwy::TargetName(target);
      }
      hwy::SetSupportedTargetsForTest(0);
      EXPECT_GE(targets, 2);
    });
}

TEST(PlannedOctaves, RefuseWhatDoesNotFit) {
  const PerlinOctaves sum(SeededOctaves({.octaves = 2, .base_frequency = 0.03}, 1, 0, "a"));
  const PixelArea area{0, 0, 8, 8};
  EXPECT_THROW(PlannedOctaves(sum, EveryWay(), area), std::invalid_argument);
  EXPECT_THROW(PlannedOctaves(sum, {.octaves = {Grid(3), {}}}, area), std::invalid_argument);
  EXPECT_THROW(PlannedOctaves(sum, {.octaves = {Grid(2, 0), {}}}, area), std::invalid_argument);
  EXPECT_THROW(PlannedOctaves(sum, {.octaves = {{.kind = OctaveWayKind::kTiled, .period_px = 64}, {}}}, area),
               std::invalid_argument);
  EXPECT_THROW(PlannedOctaves(sum, {.octaves = {{}, {}}}, {0, 0, 0, 8}), std::invalid_argument);
  const PlannedOctaves planned(sum, {.octaves = {{}, {}}}, area);
  Values row(9);
  EXPECT_THROW(planned.At(0).Row(0, 0, row), std::invalid_argument);
  row.resize(8);
  EXPECT_THROW(planned.At(0).Row(8, 0, row), std::invalid_argument);
  EXPECT_THROW(planned.At(0).Row(-1, 0, row), std::invalid_argument);
  EXPECT_THROW(planned.At(0).Row(0, -1, row), std::invalid_argument);
}

}  // namespace
}  // namespace shimmer::noise
