#include "sim/gaussian.h"

#include <cmath>

#include "noise/portable_math.h"

namespace shimmer::sim {

int GaussianRadius(double sigma_px) { return static_cast<int>(std::ceil(6 * sigma_px)); }

void GaussianWeights(double sigma_px, std::vector<double>& weights) {
  weights.assign(static_cast<size_t>(GaussianRadius(sigma_px)) + 1, 0.0);
  weights[0] = 1;
  double sum = 1;
  if (weights.size() > 1) {
    // exp(-k^2 a) from its neighbour: the ratio exp(-(2k + 1) a) shrinks by exp(-2a) each time. One exp a
    // pixel.
    const double a = 1 / (2 * sigma_px * sigma_px);
    double ratio = noise::Exp(-a);
    const double shrink = ratio * ratio;
    for (size_t k = 1; k < weights.size(); ++k) {
      weights[k] = weights[k - 1] * ratio;
      ratio *= shrink;
      sum += 2 * weights[k];
    }
  }
  for (double& weight : weights) weight /= sum;
}

}  // namespace shimmer::sim
