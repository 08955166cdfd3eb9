// The double-precision twin of noise/perlin.h: the definition, written to be read.
#pragma once

#include "noise/lattice.h"

namespace shimmer::noise {

// n at (x, y, z) in cells. Exact to 1e-12 for |coordinates| < 2^13.
double PerlinDouble(const Permutation& permutation, double x, double y, double z);

}  // namespace shimmer::noise
