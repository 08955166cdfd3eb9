#include "sim/level_mixtures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "noise/portable_math.h"
#include "sim/gaussian.h"
#include "sim/least_squares.h"

namespace shimmer::sim {
namespace {

// ---- Transfer functions, on a grid of frequencies along one axis

constexpr int kFrequencies = 40;
using Transfer = std::array<double, kFrequencies>;

constexpr double kMostVariance = 32 * 32;  // px^2; no sigma is greater
constexpr double kPi = 3.141592653589793;

// From 2 pi / 1024, below which pictures of any size are alike, to pi, each by the same factor.
const std::array<double, kFrequencies>& Frequencies() {
  static const std::array<double, kFrequencies> frequencies = [] {
    std::array<double, kFrequencies> f;
    for (int i = 0; i < kFrequencies; ++i)
      f[i] = kPi * noise::Exp(noise::Log(1.0 / 512) * (kFrequencies - 1 - i) / (kFrequencies - 1));
    return f;
  }();
  return frequencies;
}

// Of a symmetric kernel whose taps are `spacing` px apart.
Transfer TransferOf(const std::vector<double>& kernel, int spacing) {
  Transfer transfer;
  for (int i = 0; i < kFrequencies; ++i) {
    // cos(k a) by its recurrence: cos((k + 1) a) = 2 cos a cos(k a) - cos((k - 1) a)
    const double cosine = noise::Cos(Frequencies()[i] * spacing);
    double sum = kernel[0], before = 1, now = cosine;
    for (size_t k = 1; k < kernel.size(); ++k) {
      sum += 2 * kernel[k] * now;
      const double next = 2 * cosine * now - before;
      before = now, now = next;
    }
    transfer[i] = sum;
  }
  return transfer;
}

Transfer GaussianTransfer(double sigma_px) {
  std::vector<double> kernel;
  GaussianWeights(sigma_px, kernel);
  return TransferOf(kernel, 1);
}

// A cubic B-spline of this spacing, at whole pixels.
std::vector<double> SplineKernel(int spacing) {
  std::vector<double> kernel;
  for (int n = 0; n < 2 * spacing; ++n) {
    const double x = static_cast<double>(n) / spacing;
    kernel.push_back((x < 1 ? 2.0 / 3 - x * x + x * x * x / 2 : (2 - x) * (2 - x) * (2 - x) / 6) / spacing);
  }
  return kernel;
}

std::vector<Transfer> TransfersOf(const std::vector<BlurLevel>& levels) {
  std::vector<Transfer> transfers;
  Transfer coarse;  // of the coarse levels' values so far, without a spline
  coarse.fill(1);
  for (size_t k = 0; k < levels.size(); ++k) {
    const BlurLevel& level = levels[k];
    if (level.spacing_px == 1) {
      transfers.push_back(TransferOf(level.kernel, 1));
      continue;
    }
    const Transfer step = TransferOf(level.kernel, levels[k - 1].spacing_px),
                   spline = TransferOf(SplineKernel(level.spacing_px), 1);
    Transfer whole;
    for (int i = 0; i < kFrequencies; ++i) coarse[i] *= step[i], whole[i] = coarse[i] * spline[i];
    transfers.push_back(whole);
  }
  return transfers;
}

// Calls f(i, j, weight) for frequencies over the plane, weighted by the power of natural pictures:
// 1 / (fx^2 + fy^2) times the area that a grid point stands for, which grows as fx fy. x and y may change
// places: half of the plane says all.
template <class F>
void ForEachFrequency(const F& f) {
  for (int i = 0; i < kFrequencies; ++i)
    for (int j = 0; j <= i; ++j) {
      const double fx = Frequencies()[i], fy = Frequencies()[j];
      f(i, j, (i == j ? 1 : 2) * fx * fy / (fx * fx + fy * fy));
    }
}

double At(const Transfer& transfer, int i, int j) { return transfer[i] * transfer[j]; }

// ---- Mixtures

struct Window {
  size_t first, count;  // levels
};

struct Fit {
  std::vector<double> weight;  // of all levels; they sum to 1, and are 0 out of the window
  double error = 0;            // mean square over the spectrum
};

// The best mixture of a window's levels for one sigma.
Fit BestWeights(const std::vector<Transfer>& levels, Window window, const Transfer& wanted) {
  Fit fit{.weight = std::vector<double>(levels.size(), 0.0)};
  const Transfer& base = levels[window.first];
  LeastSquares squares(window.count - 1);
  std::vector<double> basis(window.count - 1);
  ForEachFrequency([&](int i, int j, double weight) {
    for (size_t r = 0; r < basis.size(); ++r)
      basis[r] = At(levels[window.first + r + 1], i, j) - At(base, i, j);
    squares.Add(basis, At(wanted, i, j) - At(base, i, j), weight);
  });
  const std::vector<double> x = squares.Solution();
  fit.weight[window.first] = 1;
  for (size_t r = 0; r < x.size(); ++r)
    fit.weight[window.first + r + 1] = x[r], fit.weight[window.first] -= x[r];
  fit.error = squares.Error(x);
  return fit;
}

// A stretch of sigma^2 up to t = most_t.
struct Stretch {
  int index;
  double most_t = 1;

  double sigma_px(double t) const { return std::sqrt(index == 0 ? t / 16 : std::ldexp(1 + t, index - 5)); }
};

// What two windows share, `to` the later one.
Window Common(Window from, Window to) { return {to.first, from.first + from.count - to.first}; }

// The windows that leave the least error in the middle of all stretches and where they meet, for there only
// what both share has a weight: no step. The first begins with level 0.
std::vector<Window> BestWindows(const std::vector<Transfer>& levels, size_t mixed,
                                const std::vector<Stretch>& stretches) {
  const auto error = [&](Window window, const Stretch& stretch, double t) {
    return BestWeights(levels, window, GaussianTransfer(stretch.sigma_px(t))).error;
  };
  struct Path {
    double error = std::numeric_limits<double>::infinity();
    std::vector<Window> windows;
  };
  const size_t firsts = levels.size() - mixed + 1;
  constexpr size_t kMostShift = 2;
  std::vector<Path> paths(firsts);  // the best so far, by the first level of its last window
  paths[0] = {0, {{0, mixed}}};
  for (size_t s = 1; s < stretches.size(); ++s) {
    const Stretch &before = stretches[s - 1], &stretch = stretches[s];
    std::vector<Path> longer(firsts);
    for (size_t first = 0; first < firsts; ++first) {
      const Window window{first, mixed};
      const double middle = error(window, stretch, 0.5 * stretch.most_t);
      for (size_t shift = 0; shift <= std::min(kMostShift, first); ++shift) {
        const Path& path = paths[first - shift];
        if (path.windows.empty()) continue;
        const double sum =
            path.error + middle + error(Common(path.windows.back(), window), before, before.most_t);
        if (sum >= longer[first].error) continue;
        longer[first] = {sum, path.windows};
        longer[first].windows.push_back(window);
      }
    }
    paths = std::move(longer);
  }
  return std::ranges::min_element(paths, {}, &Path::error)->windows;
}

// Cubics w(u) = (1 - u) first + u last + u (1 - u) (a + b u), u = t / most_t, a and b the best over the
// stretch.
BlurMixture BestCubics(const std::vector<Transfer>& levels, Window window, const Stretch& stretch,
                       const std::vector<double>& first, const std::vector<double>& last) {
  const size_t others = window.count - 1;
  LeastSquares squares(2 * others);
  std::vector<double> basis(2 * others);
  const Transfer& base = levels[window.first];
  constexpr int kPlaces = 9;
  for (int place = 0; place < kPlaces; ++place) {
    const double u = (place + 0.5) / kPlaces, bump = u * (1 - u);
    const Transfer wanted = GaussianTransfer(stretch.sigma_px(u * stretch.most_t));
    ForEachFrequency([&](int i, int j, double weight) {
      double rest = At(wanted, i, j);
      for (size_t k = window.first; k < window.first + window.count; ++k)
        rest -= ((1 - u) * first[k] + u * last[k]) * At(levels[k], i, j);
      for (size_t r = 0; r < others; ++r) {
        const double difference = At(levels[window.first + r + 1], i, j) - At(base, i, j);
        basis[2 * r] = bump * difference, basis[2 * r + 1] = bump * u * difference;
      }
      squares.Add(basis, rest, weight);
    });
  }
  const std::vector<double> x = squares.Solution();

  BlurMixture mixture{.first_level = window.first, .weight = {{1, 0, 0, 0}}};
  for (size_t r = 0; r < others; ++r) {
    const size_t k = window.first + r + 1;
    const double a = x[2 * r], b = x[2 * r + 1], most = stretch.most_t;
    mixture.weight.push_back(
        {first[k], (last[k] - first[k] + a) / most, (b - a) / (most * most), -b / (most * most * most)});
    for (size_t power = 0; power < 4; ++power) mixture.weight[0][power] -= mixture.weight.back()[power];
  }
  return mixture;
}

}  // namespace

double SplineVariance(int spacing_px) { return spacing_px > 1 ? spacing_px * spacing_px / 3.0 : 0; }

std::vector<double> LevelKernel(double sigma, int radius, bool thinned) {
  std::vector<double> weights;
  GaussianWeights(sigma, weights);
  weights.resize(static_cast<size_t>(radius) + 1);
  std::array<double, 2> sum = {weights[0], 0};  // of the taps at even and at odd places
  for (size_t k = 1; k < weights.size(); ++k) sum[k % 2] += 2 * weights[k];
  for (size_t k = 0; k < weights.size(); ++k) weights[k] /= thinned ? 2 * sum[k % 2] : sum[0] + sum[1];
  return weights;
}

double KernelVariance(const std::vector<double>& kernel) {
  double variance = 0;
  for (size_t k = 1; k < kernel.size(); ++k) variance += 2 * kernel[k] * static_cast<double>(k * k);
  return variance;
}

std::vector<BlurMixture> MakeMixtures(const std::vector<BlurLevel>& levels, size_t mixed) {
  const std::vector<Transfer> transfers = TransfersOf(levels);
  const double most = std::min(levels.back().variance_px2, kMostVariance);
  std::vector<Stretch> stretches = {{0}};
  for (int index = 1; std::ldexp(1.0, index - 5) < most; ++index)
    stretches.push_back({index, std::min(1.0, std::ldexp(most, 5 - index) - 1)});
  const std::vector<Window> windows = BestWindows(transfers, mixed, stretches);

  std::vector<BlurMixture> mixtures;
  std::vector<double> first(levels.size(), 0.0);  // weights at the start of a stretch
  first[0] = 1;
  for (size_t s = 0; s < stretches.size(); ++s) {
    const Window common = s + 1 < stretches.size() ? Common(windows[s], windows[s + 1]) : windows[s];
    const double end_px = stretches[s].sigma_px(stretches[s].most_t);
    const std::vector<double> last = BestWeights(transfers, common, GaussianTransfer(end_px)).weight;
    mixtures.push_back(BestCubics(transfers, windows[s], stretches[s], first, last));
    first = last;
  }
  return mixtures;
}

}  // namespace shimmer::sim
