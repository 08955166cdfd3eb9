#include "sim/level_mixtures.h"

#include <algorithm>
#include <cmath>

#include "noise/portable_math.h"
#include "sim/gaussian.h"

namespace shimmer::sim {
namespace {

constexpr double kKernelSigmas = 4.5;  // a level's kernel ends here

// ---- Transfer functions, on a grid of frequencies along one axis

constexpr int kFrequencies = 40;
using Transfer = std::array<double, kFrequencies>;

constexpr double kPi = 3.141592653589793;

// From 2 pi / 1024, below which pictures of any size are alike, to pi, each by the same factor.
double Frequency(int i) {
  return kPi * noise::Exp(noise::Log(1.0 / 512) * (kFrequencies - 1 - i) / (kFrequencies - 1));
}

// Of a symmetric kernel whose taps are `spacing` px apart.
Transfer TransferOf(const std::vector<double>& kernel, int spacing) {
  Transfer transfer;
  for (int i = 0; i < kFrequencies; ++i) {
    // cos(k a) by its recurrence: cos((k + 1) a) = 2 cos a cos(k a) - cos((k - 1) a)
    const double cosine = noise::Cos(Frequency(i) * spacing);
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

// ---- Least squares

// x with m x = y, m symmetric and positive: Gauss' elimination with the largest pivot.
template <size_t n>
std::array<double, n> Solve(std::array<std::array<double, n>, n> m, std::array<double, n> y) {
  for (size_t c = 0; c < n; ++c) {
    size_t pivot = c;
    for (size_t r = c + 1; r < n; ++r)
      if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
    std::swap(m[c], m[pivot]), std::swap(y[c], y[pivot]);
    for (size_t r = c + 1; r < n; ++r) {
      const double factor = m[r][c] / m[c][c];
      for (size_t k = c; k < n; ++k) m[r][k] -= factor * m[c][k];
      y[r] -= factor * y[c];
    }
  }
  std::array<double, n> x{};
  for (size_t c = n; c-- > 0;) {
    double rest = y[c];
    for (size_t k = c + 1; k < n; ++k) rest -= m[c][k] * x[k];
    x[c] = rest / m[c][c];
  }
  return x;
}

// Sums over the plane of frequencies, weighted by the power of natural pictures: 1 / (fx^2 + fy^2) times the
// area that a grid point stands for, which grows as fx fy.
template <size_t n>
class LeastSquares {
 public:
  // One more equation at each frequency: sum_k x_k basis_k = wanted; both are products of what they are along
  // x and y.
  template <class Basis, class Wanted>
  void Add(const Basis& basis, const Wanted& wanted) {
    for (int i = 0; i < kFrequencies; ++i)
      for (int j = 0; j <= i; ++j) {  // x and y may change places: half of the plane says all
        const double fx2 = frequency2_[i], fy2 = frequency2_[j];
        const double weight = (i == j ? 1 : 2) * std::sqrt(fx2 * fy2) / (fx2 + fy2);
        const std::array<double, n> b = basis(i, j);
        const double w = wanted(i, j);
        for (size_t r = 0; r < n; ++r) {
          for (size_t c = 0; c < n; ++c) m_[r][c] += weight * b[r] * b[c];
          y_[r] += weight * b[r] * w;
        }
      }
  }

  std::array<double, n> Solution() const { return Solve(m_, y_); }

 private:
  static std::array<double, kFrequencies> SquaredFrequencies() {
    std::array<double, kFrequencies> squares;
    for (int i = 0; i < kFrequencies; ++i) squares[i] = Frequency(i) * Frequency(i);
    return squares;
  }

  std::array<double, kFrequencies> frequency2_ = SquaredFrequencies();
  std::array<std::array<double, n>, n> m_{};
  std::array<double, n> y_{};
};

using Four = std::array<double, 4>;

// The best mixture of four levels for one sigma. Weights sum to 1.
Four BestWeights(const std::array<const Transfer*, 4>& level, const Transfer& wanted) {
  LeastSquares<3> squares;
  const auto value = [](const Transfer& t, int i, int j) { return t[i] * t[j]; };
  squares.Add(
      [&](int i, int j) {
        std::array<double, 3> basis;
        for (size_t r = 0; r < 3; ++r) basis[r] = value(*level[r + 1], i, j) - value(*level[0], i, j);
        return basis;
      },
      [&](int i, int j) { return value(wanted, i, j) - value(*level[0], i, j); });
  const std::array<double, 3> x = squares.Solution();
  return {1 - x[0] - x[1] - x[2], x[0], x[1], x[2]};
}

// Cubics w(t) = (1 - t) first + t last + t (1 - t) (a + b t) for the four weights, a and b the best over t.
template <class SigmaAt>
std::array<std::array<double, 4>, 4> BestCubics(const std::array<const Transfer*, 4>& level,
                                                const Four& first, const Four& last,
                                                const SigmaAt& sigma_at) {
  LeastSquares<6> squares;
  constexpr int kPlaces = 9;
  for (int place = 0; place < kPlaces; ++place) {
    const double t = (place + 0.5) / kPlaces, bump = t * (1 - t);
    const Transfer wanted = TransferOf(LevelKernel(sigma_at(t)), 1);
    squares.Add(
        [&](int i, int j) {
          std::array<double, 6> basis;
          for (size_t r = 0; r < 3; ++r) {
            const double difference =
                (*level[r + 1])[i] * (*level[r + 1])[j] - (*level[0])[i] * (*level[0])[j];
            basis[2 * r] = bump * difference, basis[2 * r + 1] = bump * t * difference;
          }
          return basis;
        },
        [&](int i, int j) {
          double rest = wanted[i] * wanted[j];
          for (size_t r = 0; r < 4; ++r)
            rest -= ((1 - t) * first[r] + t * last[r]) * (*level[r])[i] * (*level[r])[j];
          return rest;
        });
  }
  const std::array<double, 6> x = squares.Solution();
  std::array<std::array<double, 4>, 4> cubics{};
  cubics[0][0] = 1;
  for (size_t r = 1; r < 4; ++r) {
    const double a = x[2 * r - 2], b = x[2 * r - 1];
    cubics[r] = {first[r], last[r] - first[r] + a, b - a, -b};
    for (size_t power = 0; power < 4; ++power) cubics[0][power] -= cubics[r][power];
  }
  return cubics;
}

}  // namespace

double SplineVariance(int spacing_px) { return spacing_px > 1 ? spacing_px * spacing_px / 3.0 : 0; }

std::vector<double> LevelKernel(double sigma) {
  std::vector<double> weights;
  GaussianWeights(sigma, weights);
  weights.resize(std::min(weights.size(), static_cast<size_t>(std::ceil(kKernelSigmas * sigma)) + 1));
  double sum = weights[0];
  for (size_t k = 1; k < weights.size(); ++k) sum += 2 * weights[k];
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::vector<BlurMixture> MakeMixtures(const std::vector<BlurLevel>& levels) {
  const std::vector<Transfer> transfers = TransfersOf(levels);
  const int last_level = static_cast<int>(levels.size()) - 1;
  std::vector<BlurMixture> mixtures;
  Four first = {1, 0, 0, 0};  // weights at the start of a stretch, in the order of its levels
  for (int index = 0; std::ldexp(1.0, index - 5) < levels.back().variance_px2; ++index) {
    BlurMixture mixture;
    const int below = std::max(0, index - 2);  // stretches 0, 1 and 2 lie between levels 0 and 1
    if (below == 0)
      mixture.level = {0, 1, 2, 3};
    else
      mixture.level = {below, below + 1, below - 1, below + 2 <= last_level ? below + 2 : below - 2};
    std::array<const Transfer*, 4> level;
    for (size_t r = 0; r < 4; ++r) level[r] = &transfers[mixture.level[r]];

    const auto sigma_at = [&](double t) {
      return std::sqrt(index == 0 ? t / 16 : std::ldexp(1 + t, index - 5));
    };
    Four last = {0, 1, 0, 0};
    if (index < 2) last = BestWeights(level, TransferOf(LevelKernel(sigma_at(1)), 1));
    mixture.weight = BestCubics(level, first, last, sigma_at);
    mixtures.push_back(mixture);
    first = index < 2 ? last : Four{1, 0, 0, 0};
  }
  return mixtures;
}

}  // namespace shimmer::sim
