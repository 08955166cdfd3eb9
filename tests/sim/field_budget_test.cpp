// Fields within their budgets, against the double twins: tilt over the whole range of its parameters, and the
// sigma map.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "noise/hash.h"
#include "noise/simplex_double.h"
#include "sim/field_plan.h"
#include "sim/sigma_map.h"
#include "sim/tilt_field.h"

namespace shimmer::sim {
namespace {

class Draw {
 public:
  explicit Draw(uint64_t seed) : stream_(noise::HashPath(seed, 0, "field budget")) {}
  double Uniform(double low, double high) { return low + (high - low) * noise::UnitFromBits(stream_.Next()); }
  double LogUniform(double low, double high) { return low * std::exp(Uniform(0, std::log(high / low))); }
  int64_t Below(int64_t bound) { return static_cast<int64_t>(stream_.Below(static_cast<uint64_t>(bound))); }

 private:
  noise::HashStream stream_;
};

struct Place {
  noise::PixelArea area;
  int frames;
  int64_t t;
};

Place DrawPlace(Draw& draw) {
  const int64_t far = draw.Below(2) * (int64_t{1} << 20), late = draw.Below(2) * ((int64_t{1} << 31) - 100);
  return {{draw.Below(2000) - far, draw.Below(2000) + far, static_cast<int>(1 + 2 * draw.Below(60)),
           static_cast<int>(1 + draw.Below(80))},
          static_cast<int>(1 + draw.Below(64)),
          late + draw.Below(100)};
}

// Within 1e-6 cell of a simplex face either side is right.
bool OnFace(const std::vector<noise::Octave>& octaves, int64_t t, int64_t y, int64_t x) {
  for (const noise::Octave& o : octaves)
    if (noise::SimplexFaceDistance((o.origin[0] + o.step_px * x).Reduced().ToDouble(),
                                   (o.origin[1] + o.step_px * y).Reduced().ToDouble(),
                                   (o.origin[2] + o.step_frame * t).Reduced().ToDouble()) < 1e-6)
      return true;
  return false;
}

// 5e-6 of the amplitude of every octave are the row kernels' own; grids amplify it by their filter,
// below 2.5.
constexpr double kRounding = 1.5e-5;

// The steepest slope of sigma by the noise m: that of (max - min) (1 - w) Phi(m / 0.157) at m = 0.
double SigmaPerNoise(const BlurParams& blur) {
  return (blur.max_sigma_px - blur.min_sigma_px) * (1 - blur.tilt_weight) * 0.399 / kPerlinRms;
}

TEST(FieldBudget, TiltStaysWithinItOfTheDoubleTwin) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    Draw draw(seed);
    TiltParams params;
    params.strength_px = draw.Uniform(0, 64);
    params.base_frequency = draw.LogUniform(1e-6, 0.5);
    params.octaves = 1 + static_cast<int>(draw.Below(16));
    params.lacunarity = draw.Below(2) ? 2 : draw.Uniform(1, 4);
    params.persistence = draw.Uniform(0, 1);
    params.temporal_scale = draw.Below(5) ? draw.LogUniform(0.01, 100) : 0;
    params.lattice = draw.Below(2) ? LatticeKind::kSeeded : LatticeKind::kClassic;
    params.kernel = draw.Below(2) ? 0.6 : 0.5;
    const Place place = DrawPlace(draw);
    const noise::PixelArea& area = place.area;
    const double budget_px = draw.LogUniform(0.001, 1);

    const noise::FieldPlan plan =
        PlanTiltField(params, {area.width, area.height}, place.frames, {.max = budget_px});
    EXPECT_LE(plan.max_error, budget_px);
    const TiltField field(params, {.seed = seed, .clip = 0});
    const PlannedTilt planned(field, plan, area);
    const auto x_frame = planned.x.At(place.t), y_frame = planned.y.At(place.t);
    std::vector<float> dx(area.width), dy(area.width);
    const double bound = plan.max_error + kRounding * params.strength_px;
    for (int64_t y = area.y0; y < area.y0 + area.height; y += 3) {
      x_frame.Row(y, area.x0, dx);
      y_frame.Row(y, area.x0, dy);
      for (int i = 0; i < area.width; ++i) {
        const TiltField::Shift twin = field.Double(place.t, y, area.x0 + i);
        const bool x_off = std::abs(dx[i] - twin.x) > bound, y_off = std::abs(dy[i] - twin.y) > bound;
        ASSERT_TRUE(!x_off || OnFace(field.x().octaves(), place.t, y, area.x0 + i)) << "case " << seed;
        ASSERT_TRUE(!y_off || OnFace(field.y().octaves(), place.t, y, area.x0 + i)) << "case " << seed;
      }
    }
  }
}

TEST(FieldBudget, SigmaStaysWithinItOfTheDoubleTwin) {
  for (uint64_t seed = 0; seed < 100; ++seed) {
    Draw draw(seed);
    BlurParams params;
    params.max_sigma_px = draw.Uniform(0.1, 32);
    params.min_sigma_px = draw.Uniform(0, params.max_sigma_px);
    params.tilt_weight = draw.Uniform(0, 1);
    params.base_frequency = draw.LogUniform(1e-6, 0.5);
    params.octaves = 1 + static_cast<int>(draw.Below(16));
    params.lacunarity = draw.Below(2) ? 2 : draw.Uniform(1, 4);
    params.persistence = draw.Uniform(0, 1);
    params.temporal_scale = draw.LogUniform(0.01, 100);
    const LatticeKind lattice = draw.Below(2) ? LatticeKind::kSeeded : LatticeKind::kClassic;
    const Place place = DrawPlace(draw);
    const noise::PixelArea& area = place.area;
    const double budget_px = draw.LogUniform(1e-4, 0.5);

    const noise::FieldPlan plan =
        PlanBlurNoise(params, {area.width, area.height}, place.frames, budget_px / SigmaPerNoise(params));
    EXPECT_LE(plan.rms_error * SigmaPerNoise(params), budget_px * (1 + 1e-12));
    const BlurNoise field(params, lattice, {.seed = seed, .clip = 0});
    const noise::PlannedOctaves planned(field.octaves(), plan, area);
    const auto frame = planned.At(place.t);
    const double scale_px = (params.max_sigma_px - params.min_sigma_px) * (1 - params.tilt_weight);
    std::vector<float> m(area.width);
    double squares = 0;
    for (int64_t y = area.y0; y < area.y0 + area.height; ++y) {
      frame.Row(y, area.x0, m);
      for (int i = 0; i < area.width; ++i) {
        const double twin = field.Double(place.t, y, area.x0 + i);
        ASSERT_LE(std::abs(m[i] - twin), plan.max_error + kRounding) << "case " << seed;
        const double error = scale_px * (Perlin01(m[i]) - Perlin01(twin));
        squares += error * error;
      }
    }
    EXPECT_LE(std::sqrt(squares / (area.width * area.height)), budget_px + kRounding * SigmaPerNoise(params))
        << "case " << seed;
  }
}

TEST(FieldBudget, ZeroIsTheFieldItself) {
  const noise::PixelArea area{-5, 7, 201, 33};
  const TiltParams params{.base_frequency = 1.0 / 16};  // with octaves that tiles serve
  const TiltField field(params, {.seed = 0, .clip = 5});
  const PlannedTilt planned(field, PlanTiltField(params, {2000, 2000}, 4, {.max = 0}), area);
  const auto frame = planned.x.At(3);
  std::vector<float> got(area.width), full(area.width), other(area.width);
  for (int64_t y = area.y0; y < area.y0 + area.height; ++y) {
    frame.Row(y, area.x0, got);
    field.Row(3, y, area.x0, full, other);
    EXPECT_EQ(got, full);
  }
  EXPECT_EQ(planned.x.plan().octaves[4].kind, noise::OctaveWayKind::kTiled);
}

}  // namespace
}  // namespace shimmer::sim
