// Planned fields: ms a frame by error budget, with promised and measured errors. One core; 1968 x 1128 px, S
// = 5 px, 8 octaves of tilt (both axes), 11 of Perlin noise for a sigma range of 8 px at weight 0.5; 16
// frames.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "sim/field_plan.h"
#include "sim/sigma_map.h"
#include "sim/tilt_field.h"

namespace shimmer::sim {
namespace {

const noise::PixelArea kArea{-24, -24, 1968, 1128};
const cv::Size kSize(1968, 1128);
constexpr int kFrames = 64;
using Row = std::vector<float>;

struct Errors {
  double max = 0, squares = 0, count = 0;
  double rms() const { return std::sqrt(squares / count); }
};

// Against full evaluation, whose own error is 5e-6 of the amplitude.
template <class Octaves>
Errors MeasuredErrors(const noise::PlannedOctaves& planned, const Octaves& octaves) {
  Errors errors;
  Row got(kArea.width), full(kArea.width);
  for (const int64_t t : {0, 5, 11}) {
    const auto frame = planned.At(t);
    for (int64_t y = kArea.y0; y < kArea.y0 + kArea.height; ++y) {
      frame.Row(y, kArea.x0, got);
      octaves.Row(t, y, kArea.x0, full);
      for (size_t i = 0; i < got.size(); ++i) {
        const double error = std::abs(got[i] - full[i]);
        errors.max = std::max(errors.max, error), errors.squares += error * error, ++errors.count;
      }
    }
  }
  return errors;
}

void EvaluateFrame(const noise::PlannedOctaves& planned, int64_t t, Row& row) {
  const auto frame = planned.At(t);
  for (int64_t y = kArea.y0; y < kArea.y0 + kArea.height; ++y) {
    frame.Row(y, kArea.x0, row);
    benchmark::DoNotOptimize(row.data());
  }
}

std::string WaysOf(const noise::FieldPlan& plan) {
  std::string text;
  for (const noise::OctaveWay& way : plan.octaves) {
    if (way.kind == noise::OctaveWayKind::kFull) text += "full";
    if (way.kind == noise::OctaveWayKind::kDropped) text += "dropped";
    if (way.kind == noise::OctaveWayKind::kGrid) text += "grid" + std::to_string(way.spacing_px);
    if (way.kind == noise::OctaveWayKind::kTiled) text += "tile" + std::to_string(way.period_px);
    text += way.key_frames > 1 ? "/" + std::to_string(way.key_frames) + " " : " ";
  }
  return text;
}

// peak: of the sum, of which float32 loses 1e-5.
void Report(benchmark::State& state, const noise::FieldPlan& plan, const Errors& errors, double unit,
            double peak) {
  if (errors.max > plan.max_error + 1e-5 * peak || errors.rms() > plan.rms_error + 1e-5 * peak)
    state.SkipWithError("measured error above the promised one");
  state.counters["promised_max"] = plan.max_error * unit;
  state.counters["max"] = errors.max * unit;
  state.counters["promised_rms"] = plan.rms_error * unit;
  state.counters["rms"] = errors.rms() * unit;
  state.SetLabel(WaysOf(plan));
}

// The steepest slope of sigma by the noise, px.
double SigmaPerNoise(const BlurParams& blur) {
  return (blur.max_sigma_px - blur.min_sigma_px) * (1 - blur.tilt_weight) * 0.399 / kPerlinRms;
}

void Tilt(benchmark::State& state, double frequency, double budget_px, double temporal_scale) {
  const TiltParams params{.strength_px = 5, .base_frequency = frequency, .temporal_scale = temporal_scale};
  const noise::FieldPlan plan = PlanTiltField(params, kSize, kFrames, {.max = budget_px});
  const TiltField field(params, {.seed = 1, .clip = 0});
  const PlannedTilt planned(field, plan, kArea);
  Row row(kArea.width);
  int64_t t = 0;
  for (auto _ : state) {
    EvaluateFrame(planned.x, t % kFrames, row);
    EvaluateFrame(planned.y, t++ % kFrames, row);
  }
  Report(state, plan, MeasuredErrors(planned.x, field.x()), 1, params.strength_px);
}

void Sigma(benchmark::State& state, double frequency, double budget_px, double temporal_scale) {
  const BlurParams params{.max_sigma_px = 8, .base_frequency = frequency, .temporal_scale = temporal_scale};
  const noise::FieldPlan plan = PlanBlurNoise(params, kSize, kFrames, budget_px / SigmaPerNoise(params));
  const BlurNoise field(params, LatticeKind::kSeeded, {.seed = 1, .clip = 0});
  const noise::PlannedOctaves planned(field.octaves(), plan, kArea);
  Row row(kArea.width);
  int64_t t = 0;
  for (auto _ : state) EvaluateFrame(planned, t++ % kFrames, row);
  Report(state, plan, MeasuredErrors(planned, field.octaves()), SigmaPerNoise(params), 1);
}

}  // namespace
}  // namespace shimmer::sim

int main(int argc, char** argv) {
  using namespace shimmer::sim;
  const auto add = [](const std::string& what, auto run, double frequency, double budget,
                      double temporal_scale) {
    const std::string name = what + "/f=" + NumberText(frequency) + "/" + NumberText(budget) + "px";
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& s) {
      run(s, frequency, budget, temporal_scale);
    })->Unit(benchmark::kMillisecond);
  };
  for (const double frequency : {1 / 64.0, 0.03}) {
    for (const double budget : {0.0, 0.01, 0.05, 0.1, 0.3}) add("tilt", Tilt, frequency, budget, 2);
    for (const double budget : {0.0, 0.003, 0.006, 0.02, 0.1}) add("sigma", Sigma, frequency, budget, 2);
    add("slow tilt", Tilt, frequency, 0.05, 0.1);  // with key frames
    add("slow sigma", Sigma, frequency, 0.006, 0.1);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
