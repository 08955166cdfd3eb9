#include "sim/least_squares.h"

#include <cmath>
#include <utility>

namespace shimmer::sim {

LeastSquares::LeastSquares(size_t unknowns)
    : m_(unknowns, std::vector<double>(unknowns, 0.0)), y_(unknowns, 0.0) {}

void LeastSquares::Add(const std::vector<double>& basis, double wanted, double weight) {
  for (size_t r = 0; r < y_.size(); ++r) {
    const double b = weight * basis[r];
    for (size_t c = 0; c < y_.size(); ++c) m_[r][c] += b * basis[c];
    y_[r] += b * wanted;
  }
  wanted2_ += weight * wanted * wanted;
  weights_ += weight;
}

// Gauss' elimination with the largest pivot.
std::vector<double> LeastSquares::Solution() const {
  auto m = m_;
  auto y = y_;
  const size_t n = y.size();
  for (size_t c = 0; c < n; ++c) {
    size_t pivot = c;
    for (size_t r = c + 1; r < n; ++r)
      if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
    std::swap(m[c], m[pivot]), std::swap(y[c], y[pivot]);
    for (size_t r = c + 1; r < n; ++r) {
      const double factor = m[r][c] / m[c][c];
      for (size_t k = c; k < n; ++k) m[r][k] -= factor * m[c][k];
      y[r] -= factor * y[c];
    }
  }
  std::vector<double> x(n);
  for (size_t c = n; c-- > 0;) {
    double rest = y[c];
    for (size_t k = c + 1; k < n; ++k) rest -= m[c][k] * x[k];
    x[c] = rest / m[c][c];
  }
  return x;
}

double LeastSquares::Error(const std::vector<double>& x) const {
  double error = wanted2_;
  for (size_t r = 0; r < y_.size(); ++r) {
    error -= 2 * x[r] * y_[r];
    for (size_t c = 0; c < y_.size(); ++c) error += x[r] * m_[r][c] * x[c];
  }
  return error / weights_;
}

}  // namespace shimmer::sim
