// Numbers put into bins: what histograms are drawn from.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cli/ticks.h"

namespace shimmer::app {

// The numbers in [low, high): of the last bin, in [low, high].
struct Bin {
  double low, high;
  int64_t count;
  std::string text;  // "2 to 2.5"; of a bin for one number: "7"
};

// sorted: numbers in ascending order, at least one, none beyond +-1e100; logarithmic: positive, and their
// ratio is finite. Gives some 15 to 30 bins side by side, which hold
// every number; fewer where there are no more whole numbers, and one if all are the same.
std::vector<Bin> PutIntoBins(std::span<const double> sorted, cli::AxisKind kind);

}  // namespace shimmer::app
