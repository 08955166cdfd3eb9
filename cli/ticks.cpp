#include "cli/ticks.h"

#include <algorithm>
#include <cmath>

namespace shimmer::cli {

std::vector<double> Ticks(double low, double high, size_t most, AxisKind kind) {
  std::vector<double> ticks;
  if (kind == AxisKind::kLogarithmic) {
    std::vector<double> powers;
    for (double exponent = std::floor(std::log10(low)); exponent <= std::log10(high); ++exponent) {
      for (const double step : {1.0, 2.0, 5.0}) {
        const double tick = step * std::pow(10, exponent);
        if (tick < low || tick > high) continue;
        ticks.push_back(tick);
        if (step == 1) powers.push_back(tick);
      }
    }
    if (ticks.size() > most) ticks = powers;
    for (const auto every = ticks.size() / most + 1; ticks.size() > most;) {  // very many powers
      std::vector<double> fewer;
      for (size_t i = 0; i < ticks.size(); i += every) fewer.push_back(ticks[i]);
      ticks = fewer;
    }
    if (ticks.size() >= 2) return ticks;
    ticks.clear();
  }
  const double least = (high - low) / static_cast<double>(most);
  const double step =
      kind == AxisKind::kWhole ? std::max(1.0, RoundUp(least, {1, 2, 5})) : RoundUp(least, {1, 2, 2.5, 5});
  for (double k = std::ceil(low / step); k <= std::floor(high / step); ++k) ticks.push_back(k * step);
  return ticks;
}

double RoundUp(double value, std::initializer_list<double> steps) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : steps)
    if (step * power >= value) return step * power;
  return 10 * power;
}

}  // namespace shimmer::cli
