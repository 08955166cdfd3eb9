#include "restore/rolling.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace shimmer::restore {

std::optional<double> MeanOfPresent(std::span<const std::optional<double>> values) {
  double sum = 0, count = 0;
  for (const auto& value : values)
    if (value) sum += *value, ++count;
  if (count == 0) return {};
  return sum / count;
}

std::vector<std::optional<Spread>> Rolling(std::span<const std::optional<double>> values, int frames) {
  if (frames < 1) throw std::invalid_argument("frames = " + std::to_string(frames) + ", must be at least 1");
  std::vector<std::optional<Spread>> rolling;
  for (size_t end = 1; end <= values.size(); ++end) {
    const size_t count = std::min(end, static_cast<size_t>(frames));
    const auto window = values.subspan(end - count, count);
    const auto mean = MeanOfPresent(window);
    if (!mean) {
      rolling.emplace_back();
      continue;
    }
    std::vector<std::optional<double>> squares;
    for (const auto& value : window)
      if (value) squares.emplace_back((*value - *mean) * (*value - *mean));
    rolling.emplace_back(Spread{*mean, std::sqrt(*MeanOfPresent(squares))});
  }
  return rolling;
}

}  // namespace shimmer::restore
