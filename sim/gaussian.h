// Weights of the sampled Gaussian: the one kernel that every blur here is measured against.
#pragma once

#include <vector>

namespace shimmer::sim {

// Pixels on each side of the centre: six sigma, beyond which 2e-9 of the light lies.
int GaussianRadius(double sigma_px);

// w[k] = exp(-k^2 / (2 sigma^2)) / N, k = 0 .. radius, with w[0] + 2 (w[1] + ...) = 1. {1} where sigma is 0.
void GaussianWeights(double sigma_px, std::vector<double>& weights);

}  // namespace shimmer::sim
