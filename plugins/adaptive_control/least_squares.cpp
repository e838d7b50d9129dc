#include "least_squares.hpp"

namespace bodeflow::adaptive_control {

double FullLeastSquares::measure(const Regressor& phi, const Regressor& zeta, double lambda) {
  Regressor p_zeta{}, phi_p{};
  double denominator = lambda;
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t k = 0; k < n_; ++k) {
      p_zeta[i] += p_[i][k] * zeta[k];
      phi_p[i] += phi[k] * p_[k][i];
    }
  }
  for (std::size_t i = 0; i < n_; ++i) denominator += phi[i] * p_zeta[i];
  gain_ = {};
  if (!(denominator > 0.5 * lambda)) return lambda;
  instrumental_ = true;
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t k = 0; k < n_; ++k) instruments_[i][k] = lambda * instruments_[i][k] + zeta[i] * zeta[k];
  }
  for (std::size_t i = 0; i < n_; ++i) gain_[i] = p_zeta[i] / denominator;
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t k = 0; k < n_; ++k) p_[i][k] = (p_[i][k] - gain_[i] * phi_p[k]) / lambda;
  }
  return denominator;
}

double FullLeastSquares::measure_directional(const Regressor& phi, double lambda) {
  Regressor p_phi{};
  double r = 0.0;
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t k = 0; k < n_; ++k) p_phi[i] += p_[i][k] * phi[k];
    r += phi[i] * p_phi[i];
  }
  for (std::size_t i = 0; i < n_; ++i) gain_[i] = p_phi[i] / (1.0 + r);
  if (!(r > 0.0)) return 1.0;
  const double share = lambda - (1.0 - lambda) / r;
  if (share == 0.0) return 1.0 + r;
  const double factor = 1.0 / (1.0 / share + r);
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t k = 0; k < n_; ++k) p_[i][k] -= factor * p_phi[i] * p_phi[k];
  }
  return 1.0 + r;
}

double FullLeastSquares::covariance(std::size_t i, std::size_t k) const {
  if (!instrumental_) return p_[i][k];
  double sum = 0.0;
  for (std::size_t a = 0; a < n_; ++a) {
    for (std::size_t b = 0; b < n_; ++b) sum += p_[i][a] * instruments_[a][b] * p_[k][b];
  }
  return sum;
}

bool FullLeastSquares::bound(double limit) {
  double trace = 0.0;
  for (std::size_t i = 0; i < n_; ++i) trace += std::abs(p_[i][i]);
  const double allowed = limit * static_cast<double>(n_);
  if (trace <= allowed) return false;
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t k = 0; k < n_; ++k) p_[i][k] *= allowed / trace;
  }
  return true;
}

}  // namespace bodeflow::adaptive_control
