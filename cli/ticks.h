// Round numbers along an axis.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <vector>

namespace shimmer::cli {

enum class AxisKind {
  kLinear,       // bins of one round width
  kLogarithmic,  // bins of one ratio; numbers must be positive
  kWhole,        // whole numbers, each in the middle of its bin
};

// Round numbers in [low, high], ascending, some three to `most` of them. low < high; logarithmic: 0 < low.
std::vector<double> Ticks(double low, double high, size_t most, AxisKind kind);

// The next of the steps (ascending, the first is 1) times a power of ten that is not below value > 0.
double RoundUp(double value, std::initializer_list<double> steps);

}  // namespace shimmer::cli
