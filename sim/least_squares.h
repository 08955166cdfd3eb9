// Small linear least squares, by the normal equations.
#pragma once

#include <cstddef>
#include <vector>

namespace shimmer::sim {

class LeastSquares {
 public:
  explicit LeastSquares(size_t unknowns);

  // One more equation: sum_k x_k basis[k] = wanted. basis: as many as there are unknowns.
  void Add(const std::vector<double>& basis, double wanted, double weight);

  std::vector<double> Solution() const;
  // Mean of the squared errors that x leaves, weighted.
  double Error(const std::vector<double>& x) const;

 private:
  std::vector<std::vector<double>> m_;
  std::vector<double> y_;
  double wanted2_ = 0, weights_ = 0;
};

}  // namespace shimmer::sim
