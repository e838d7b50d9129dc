#include "rst_design.hpp"

#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>

#include "householder.hpp"
#include "numbers_in_text.hpp"

namespace bodeflow::adaptive_control {
namespace {

constexpr double kLeastResponse = 1e-12;  // |G| below it is no plant: F_R would be beyond all scales

Coefficients coefficients_of(const Eigen::VectorXd& polynomial) {
  Coefficients c{};
  for (Eigen::Index i = 0; i < polynomial.size(); ++i) c[static_cast<std::size_t>(i)] = polynomial[i];
  return c;
}

std::string observer_error(const Eigen::VectorXd& a_o, int n_r) {
  if (a_o.size() == 0 || a_o[0] != 1.0) return "the observer polynomial is not monic";
  if (a_o.size() - 1 > n_r) {
    return "the observer polynomial has degree " + std::to_string(a_o.size() - 1) + ", R has " + std::to_string(n_r) +
           "; allowed: no more than that";
  }
  const auto roots = numerics::roots(a_o);
  if (!roots) return "the observer polynomial: " + roots.error().text;
  for (const std::complex<double>& root : *roots) {
    if (!(std::abs(root) < 1.0)) {
      return "the observer polynomial has the root " + text_of(root) + "; allowed: roots inside the unit circle";
    }
  }
  return {};
}

/// p q, of degrees n and m.
Coefficients product(const Coefficients& p, int n, const Coefficients& q, int m) {
  Coefficients result{};
  for (std::size_t i = 0; i <= static_cast<std::size_t>(n); ++i) {
    for (std::size_t k = 0; k <= static_cast<std::size_t>(m); ++k) result[i + k] += p[i] * q[k];
  }
  return result;
}

}  // namespace

Expected<RstDesign> RstDesign::make(const RstStructure& s, const std::vector<std::complex<double>>& g_m,
                                    const Eigen::VectorXd& a_o) {
  std::string error = structure_error(s);
  if (error.empty()) error = observer_error(a_o, s.n_r);
  if (!error.empty()) return refused(error);
  if (g_m.size() != s.omega.size()) {
    return refused(std::to_string(g_m.size()) + " points of the desired response for " + std::to_string(s.omega.size()) +
                   " frequencies; allowed: one each");
  }
  RstDesign d;
  d.points_ = static_cast<int>(s.omega.size());
  d.n_r_ = s.n_r;
  d.n_s_ = s.n_s;
  d.n_t_ = static_cast<int>(a_o.size()) - 1;
  d.n_r_bar_ = s.n_r_bar();
  d.n_s_bar_ = s.n_s_bar();
  d.r_p_ = coefficients_of(s.r_p);
  d.s_p_ = coefficients_of(s.s_p);
  d.a_o_ = coefficients_of(a_o);
  d.integral_action_ = std::abs(s.r_p.sum()) < 1e-12;
  for (std::size_t j = 0; j < g_m.size(); ++j) {
    if (!(std::abs(g_m[j]) > 0.0) || !std::isfinite(std::abs(g_m[j]))) {
      return refused("the desired response is " + text_of(g_m[j]) + " at " + text_of(s.omega[j]) +
                     " rad/s; allowed: finite and not 0");
    }
    const std::complex<double> z = std::polar(1.0, s.omega[j] * s.sample_time);
    d.z_[j] = z;
    d.g_m_[j] = g_m[j];
    const double v = d.weight_[j] = s.weights.empty() ? 1.0 : s.weights[j];
    const std::complex<double> common = v * g_m[j] / value_at(d.a_o_, d.n_t_, z);
    const std::complex<double> f_r_g = common * value_at(d.r_p_, d.n_r_ - d.n_r_bar_, z);  // (3.11)
    const std::complex<double> f_s = common * value_at(d.s_p_, d.n_s_ - d.n_s_bar_, z);
    for (int k = 0; k <= d.n_r_bar_; ++k)
      d.r_row_[j][static_cast<std::size_t>(k)] = f_r_g * std::pow(z, d.n_r_bar_ - k);                                    // (3.14)
    for (int k = 0; k <= d.n_s_bar_; ++k) d.s_row_[j][static_cast<std::size_t>(k)] = f_s * std::pow(z, d.n_s_bar_ - k);  // (3.15)
  }
  return d;
}

bool RstDesign::solve(const std::complex<double>* g, RstResult& result) const {
  const int unknowns = n_r_bar_ + n_s_bar_ + 2, rows = 2 * points_;
  LeastSquaresRows<kMostRows, kMostUnknowns> phi(rows, unknowns);  // (3.25), (3.26)
  for (int j = 0; j < points_; ++j) {
    const double size = std::norm(g[j]);
    if (!(size > kLeastResponse * kLeastResponse) || !std::isfinite(size)) return false;
    const std::complex<double> inverse = std::conj(g[j]) / size;
    const auto at = static_cast<std::size_t>(j);
    for (int k = 0; k <= n_r_bar_; ++k) {
      const std::complex<double>& row = r_row_[at][static_cast<std::size_t>(k)];
      phi.at(j, k) = row.real() * inverse.real() - row.imag() * inverse.imag();
      phi.at(points_ + j, k) = row.real() * inverse.imag() + row.imag() * inverse.real();
    }
    for (int k = 0; k <= n_s_bar_; ++k) {
      const std::complex<double>& row = s_row_[at][static_cast<std::size_t>(k)];
      phi.at(j, n_r_bar_ + 1 + k) = row.real();
      phi.at(points_ + j, n_r_bar_ + 1 + k) = row.imag();
    }
    phi.right_side(j) = weight_[at];
    phi.right_side(points_ + j) = 0.0;
  }
  std::array<double, kMostUnknowns> theta;
  if (!phi.solve(theta.data(), result.residual)) return false;
  if (!(theta[0] > 0.0) || !std::isfinite(1.0 / theta[0])) return false;
  result_of(theta.data(), result);
  return true;
}

/// theta = (1, r_1 .., s_0 ..) / t0 (3.12) as polynomials, with their prescribed factors (3.4).
void RstDesign::result_of(const double* theta, RstResult& result) const {
  const double t0 = 1.0 / theta[0];
  Coefficients r_bar{}, s_bar{};
  r_bar[0] = 1.0;
  for (int k = 1; k <= n_r_bar_; ++k) r_bar[static_cast<std::size_t>(k)] = theta[k] * t0;
  for (int k = 0; k <= n_s_bar_; ++k) s_bar[static_cast<std::size_t>(k)] = theta[n_r_bar_ + 1 + k] * t0;
  Rst& c = result.rst;
  c.n_r = n_r_;
  c.n_s = n_s_;
  c.n_t = n_t_;
  c.r = product(r_p_, n_r_ - n_r_bar_, r_bar, n_r_bar_);
  c.s = product(s_p_, n_s_ - n_s_bar_, s_bar, n_s_bar_);
  result.t0 = t0;
  result.r_bar = r_bar;
  result.gain_ratio = 1.0;
  double gain = t0;
  if (integral_action_) {
    // Unit gain at rest, although the fit at zero frequency is not exact: T_used = S(1) / T(1) T.
    gain = value_at(c.s, n_s_, 1.0) / value_at(a_o_, n_t_, 1.0);
    result.gain_ratio = gain / t0;
  }
  c.t = a_o_;
  for (double& t : c.t) t *= gain;
}

}  // namespace bodeflow::adaptive_control
