// Means over the frames of a sequence, in which a value may be absent.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace shimmer::restore {

// Of those that are there; nothing where none is. Infinite where one is.
std::optional<double> MeanOfPresent(std::span<const std::optional<double>> values);

struct Spread {
  double mean, standard_deviation;  // of the population: 0 for one value
};

// For each frame the spread of what is there of the last `frames` up to and with it (fewer at the start);
// nothing where none is. Throws std::invalid_argument if frames < 1.
std::vector<std::optional<Spread>> Rolling(std::span<const std::optional<double>> values, int frames);

}  // namespace shimmer::restore
