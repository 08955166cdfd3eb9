#include "sim/sensor.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "noise/hash.h"
#include "noise/portable_math.h"

namespace shimmer::sim {
namespace {

constexpr double kFewElectrons = 64;

// Quantiles of the normal distribution at (i + 0.5) / 2^16, scaled to variance 1: a sample's noise is one
// look-up, and never beyond 4.3 standard deviations.
const std::vector<float>& NormalNumbers() {
  static const std::vector<float> numbers = [] {
    constexpr size_t kNumbers = 1 << 16;
    std::vector<double> exact(kNumbers);
    double squares = 0;
    for (size_t i = 0; i < kNumbers; ++i) {
      exact[i] = noise::NormalQuantile((static_cast<double>(i) + 0.5) / kNumbers);
      squares += exact[i] * exact[i];
    }
    const double scale = std::sqrt(kNumbers / squares);
    std::vector<float> numbers(kNumbers);
    std::ranges::transform(exact, numbers.begin(), [&](double x) { return static_cast<float>(scale * x); });
    return numbers;
  }();
  return numbers;
}

// 64 bits a sample, by its place: the low 16 for reading, those above for photons.
class RowNoise {
 public:
  RowNoise(ClipKey key, int64_t t, int y, int channel)
      : key_(noise::HashPath(
            key.seed, key.clip,
            "sensor." + std::to_string(t) + "." + std::to_string(channel) + "." + std::to_string(y))) {}

  uint64_t At(int x) const {
    noise::HashStream stream(key_ + static_cast<uint64_t>(x) * 0x9E3779B97F4A7C15u);  // x numbers further on
    return stream.Next();
  }

 private:
  uint64_t key_;
};

// By inversion: the smallest number that a Poisson variable of this mean exceeds with a chance below 1 -
// uniform.
double Poisson(double mean, double uniform) {
  double chance = noise::Exp(-mean), sum = chance;
  int number = 0;
  while (uniform >= sum && chance > 0) chance *= mean / ++number, sum += chance;
  return number;
}

}  // namespace

void SenseRow(const SensorParams& sensor, ClipKey key, int64_t t, int y, int channel, int x0,
              std::span<float> row) {
  if (sensor.veil > 0) {
    const auto kept = static_cast<float>(1 - sensor.veil),
               added = static_cast<float>(sensor.veil * sensor.veil_level);
    for (float& sample : row) sample = kept * sample + added;
  }
  if (sensor.Noisy()) {
    const std::vector<float>& normal = NormalNumbers();
    const RowNoise noise_at(key, t, y, channel);
    const auto read = static_cast<float>(sensor.read_noise / 255);
    for (size_t i = 0; i < row.size(); ++i) {
      const uint64_t bits = noise_at.At(x0 + static_cast<int>(i));
      float& sample = row[i];
      if (sensor.full_well > 0 && sample > 0) {
        const double electrons = sample * sensor.full_well;
        const double seen = electrons < kFewElectrons
                                ? Poisson(electrons, noise::UnitFromBits(bits & ~uint64_t{0xffff}))
                                : electrons + std::sqrt(electrons) * normal[bits >> 48];
        sample = static_cast<float>(seen / sensor.full_well);
      }
      sample += read * normal[bits & 0xffff];
    }
  }
  if (sensor.bits > 0) {
    const auto steps = static_cast<float>((1 << sensor.bits) - 1);
    for (float& sample : row) sample = std::nearbyint(std::clamp(sample, 0.0f, 1.0f) * steps) / steps;
  }
}

}  // namespace shimmer::sim
