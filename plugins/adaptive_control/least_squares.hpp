#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bodeflow::adaptive_control {

inline constexpr int kMostParameters = 8;
using Regressor = std::array<double, kMostParameters>;

/// Recursive least squares with exponential forgetting (algorithm 4.1 of Kallen 1992),
///   K = P phi / (lambda + phi' P phi), theta += K (y - phi' theta), P = (P - K phi' P) / lambda,
/// with P = U D U', U upper triangular with ones on its diagonal: P stays positive definite whatever rounding does.
/// Method: Bierman, Factorization Methods for Discrete Sequential Estimation, 1977, section V.3. Cost about 2 n^2; no allocation.
class UdLeastSquares {
 public:
  UdLeastSquares() = default;
  /// n <= kMostParameters, theta = 0, P = p0 I.
  UdLeastSquares(int n, double p0) : n_(static_cast<std::size_t>(n)) {
    d_.fill(p0);
    for (std::size_t i = 0; i < n_; ++i) u_[i][i] = 1.0;
  }

  double prediction(const Regressor& phi) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < n_; ++i) sum += phi[i] * theta_[i];
    return sum;
  }

  /// Takes phi into P and leaves the gain K for `correct`. Returns lambda + phi' P phi with the P before.
  double measure(const Regressor& phi, double lambda) {
    double before = lambda;
    for (std::size_t j = 0; j < n_; ++j) {
      double f = phi[j];
      for (std::size_t i = 0; i < j; ++i) f += u_[i][j] * phi[i];
      const double v = d_[j] * f;
      const double after = before + v * f;
      d_[j] *= before / (after * lambda);
      gain_[j] = v;
      const double back = -f / before;
      for (std::size_t i = 0; i < j; ++i) {
        const double old = u_[i][j];
        u_[i][j] = old + gain_[i] * back;
        gain_[i] += old * v;
      }
      before = after;
    }
    for (std::size_t i = 0; i < n_; ++i) gain_[i] /= before;
    return before;
  }

  /// theta += K error
  void correct(double error) {
    for (std::size_t i = 0; i < n_; ++i) theta_[i] += gain_[i] * error;
  }

  /// Cuts D off at `limit`, so that P cannot grow without bound while nothing excites. True where it acted.
  bool bound(double limit) {
    bool acted = false;
    for (std::size_t i = 0; i < n_; ++i) {
      acted |= d_[i] > limit;
      d_[i] = std::min(d_[i], limit);
    }
    return acted;
  }

  const Regressor& theta() const { return theta_; }
  double covariance(std::size_t i, std::size_t k) const {
    double sum = 0.0;
    for (std::size_t j = std::max(i, k); j < n_; ++j) sum += u_[i][j] * d_[j] * u_[k][j];
    return sum;
  }

 private:
  std::size_t n_ = 0;
  Regressor theta_{}, d_{}, gain_{};
  std::array<Regressor, kMostParameters> u_{};
};

/// The same with a full P, for updates that no U D U' has: directional forgetting and instrumental variables. No allocation.
class FullLeastSquares {
 public:
  FullLeastSquares() = default;
  FullLeastSquares(int n, double p0) : n_(static_cast<std::size_t>(n)) {
    for (std::size_t i = 0; i < n_; ++i) p_[i][i] = p0;
  }

  double prediction(const Regressor& phi) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < n_; ++i) sum += phi[i] * theta_[i];
    return sum;
  }

  /// Instrumental variables: K = P zeta / (lambda + phi' P zeta), P = (P - K phi' P) / lambda. Returns the denominator; where it
  /// is not above lambda / 2 the instruments say nothing of phi and K is 0.
  double measure(const Regressor& phi, const Regressor& zeta, double lambda);

  /// Directional forgetting (Kulhavy & Karny, Tracking of slowly varying parameters by directional forgetting, IFAC 1984): old
  /// data is forgotten only along phi. With r = phi' P phi: K = P phi / (1 + r), P -= P phi phi' P / (1 / e + r),
  /// e = lambda - (1 - lambda) / r. Returns 1 + r.
  double measure_directional(const Regressor& phi, double lambda);

  void correct(double error) {
    for (std::size_t i = 0; i < n_; ++i) theta_[i] += gain_[i] * error;
  }
  /// Scales P down so that its trace keeps n times `limit`. True where it acted.
  bool bound(double limit);

  const Regressor& theta() const { return theta_; }
  /// P, or with instruments P (sum zeta zeta') P': the covariance of theta over the noise's variance.
  double covariance(std::size_t i, std::size_t k) const;

 private:
  std::size_t n_ = 0;
  Regressor theta_{}, gain_{};
  std::array<Regressor, kMostParameters> p_{}, instruments_{};
  bool instrumental_ = false;
};

}  // namespace bodeflow::adaptive_control
