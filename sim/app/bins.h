// Numbers put into bins, and the ticks of an axis: what histograms are drawn from.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace shimmer::app {

enum class AxisKind {
  kLinear,       // bins of one round width
  kLogarithmic,  // bins of one ratio; numbers must be positive
  kWhole,        // whole numbers, each in the middle of its bin
};

// The numbers in [low, high): of the last bin, in [low, high].
struct Bin {
  double low, high;
  int64_t count;
  std::string text;  // "2 to 2.5"; of a bin for one number: "7"
};

// sorted: numbers in ascending order, at least one, none beyond +-1e100; logarithmic: positive, and their
// ratio is finite. Gives some 15 to 30 bins side by side, which hold
// every number; fewer where there are no more whole numbers, and one if all are the same.
std::vector<Bin> PutIntoBins(std::span<const double> sorted, AxisKind kind);

// Round numbers in [low, high], ascending, some three to `most` of them. low < high; logarithmic: 0 < low.
std::vector<double> Ticks(double low, double high, size_t most, AxisKind kind);

// The next of the steps (ascending, the first is 1) times a power of ten that is not below value > 0.
double RoundUp(double value, std::initializer_list<double> steps);

}  // namespace shimmer::app
