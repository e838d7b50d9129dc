#include "poles.hpp"

#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <numbers>
#include <string>

namespace bodeflow::koopmans_levin {

namespace {

using Complex = std::complex<double>;

// ds/da_i at a pole, i = 1 .. n.
Eigen::VectorXcd sensitivity(const Eigen::VectorXd& a, Complex z, double sample_time) {
  const Eigen::Index n = a.size() - 1;
  Complex slope = 0.0, power = 1.0;  // dA/dz of z^n + a_1 z^(n-1) + ..
  Eigen::VectorXcd change(n);
  for (Eigen::Index i = n; i >= 1; --i) {
    change[i - 1] = power;  // z^(n-i)
    slope += static_cast<double>(n - i + 1) * a[i - 1] * power;
    power *= z;
  }
  return -change / (slope * z * sample_time);
}

}  // namespace

Expected<std::vector<Pole>> poles(const Model& model, const Eigen::MatrixXd& covariance, double sample_time) {
  const Eigen::Index n = model.order();
  if (!(sample_time > 0.0) || !std::isfinite(sample_time)) return refused("the sample time must be above 0 s and finite");
  if (covariance.rows() < n || covariance.cols() < n) {
    return refused("the covariance must be at least " + std::to_string(n) + " x " + std::to_string(n));
  }
  const auto roots = numerics::roots(model.a);
  if (!roots) return tl::make_unexpected(roots.error());
  std::vector<Pole> found;
  for (const Complex z : *roots) {
    Pole p;
    p.z = z;
    p.s_rad_s = std::log(z) / sample_time;
    p.frequency_hz = std::abs(p.s_rad_s) / (2.0 * std::numbers::pi);
    p.damping_ratio = -p.s_rad_s.real() / std::abs(p.s_rad_s);
    const Eigen::VectorXcd g = sensitivity(model.a, z, sample_time);
    const Eigen::VectorXd re = g.real(), im = g.imag();
    p.real_std_rad_s = std::sqrt(re.dot(covariance.topLeftCorner(n, n) * re));
    p.imaginary_std_rad_s = std::sqrt(im.dot(covariance.topLeftCorner(n, n) * im));
    found.push_back(p);
  }
  return found;
}

}  // namespace bodeflow::koopmans_levin
