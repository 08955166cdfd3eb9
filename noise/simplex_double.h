// The double-precision twin of noise/simplex.h: the definition, written to be read.
#pragma once

#include "noise/lattice.h"
#include "noise/simplex.h"

namespace shimmer::noise {

// n at (x, y, z) in cells; kSimplexKernel06 is snoise3. Exact to 1e-12 for |coordinates| < 2^13.
double SimplexDouble(const Permutation& permutation, const SimplexKernel& kernel, double x, double y,
                     double z);

// Distance in cells, along the skewed axes, from the nearest face between two simplices of a cell or two
// cells. Near 0 the two sides of a jump of the 0.6 kernel are both right.
double SimplexFaceDistance(double x, double y, double z);

}  // namespace shimmer::noise
