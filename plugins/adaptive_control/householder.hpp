#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bodeflow::adaptive_control {

/// Real least-squares rows of fixed capacity, solved by Householder reflections in place: no allocation, cost 2 m n^2 for m rows
/// and n unknowns. Stored by columns; the right side is the last one.
template <int kRows, int kUnknowns>
class LeastSquaresRows {
 public:
  /// m >= n, neither beyond the capacity.
  LeastSquaresRows(int m, int n) : m_(m), n_(n) {}

  double& at(int row, int column) { return column_[static_cast<std::size_t>(column)][static_cast<std::size_t>(row)]; }
  double& right_side(int row) { return at(row, n_); }

  /// theta and ||b - A theta||; false where a column is linearly dependent to rounding, or anything is not finite.
  bool solve(double* theta, double& residual) {
    for (int k = 0; k < n_; ++k) {
      if (!reflect(k)) return false;
    }
    for (int k = n_ - 1; k >= 0; --k) {
      double sum = at(k, n_);
      for (int c = k + 1; c < n_; ++c) sum -= at(k, c) * theta[c];
      theta[k] = sum / at(k, k);
    }
    double squares = 0.0;
    for (int i = n_; i < m_; ++i) squares += at(i, n_) * at(i, n_);
    residual = std::sqrt(squares);
    return std::isfinite(residual);
  }

 private:
  // Takes column k below its diagonal to zero. What is left of the column after the reflections before must be more than
  // rounding.
  bool reflect(int k) {
    double* v = column_[static_cast<std::size_t>(k)].data();
    double below = 0.0, above = 0.0;
    for (int i = 0; i < k; ++i) above += v[i] * v[i];
    for (int i = k; i < m_; ++i) below += v[i] * v[i];
    constexpr double kRounding = 1e-26;  // squares: 1e-13 of the column
    if (!(below > kRounding * above) || !std::isfinite(below)) return false;
    const double length = std::sqrt(below);
    const double diagonal = v[k] > 0.0 ? -length : length;
    v[k] -= diagonal;
    const double scale = -1.0 / (diagonal * v[k]);  // 2 / v'v
    for (int c = k + 1; c <= n_; ++c) {
      double* x = column_[static_cast<std::size_t>(c)].data();
      double dot = 0.0;
      for (int i = k; i < m_; ++i) dot += v[i] * x[i];
      dot *= scale;
      for (int i = k; i < m_; ++i) x[i] -= dot * v[i];
    }
    v[k] = diagonal;
    return true;
  }

  int m_, n_;
  std::array<std::array<double, kRows>, kUnknowns + 1> column_;
};

}  // namespace bodeflow::adaptive_control
