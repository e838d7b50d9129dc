#include "poles.hpp"

#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <numbers>
#include <string>

namespace bodeflow::koopmans_levin {

namespace {

using Complex = std::complex<double>;

// Covariance of real and imaginary part of factor * z, from that of z.
Eigen::Matrix2d scaled(const Eigen::Matrix2d& covariance, Complex factor) {
  Eigen::Matrix2d slope;
  slope << factor.real(), -factor.imag(), factor.imag(), factor.real();
  return slope * covariance * slope.transpose();
}

}  // namespace

std::vector<Eigen::Matrix2d> root_covariance(const Eigen::VectorXd& polynomial, const Eigen::MatrixXd& covariance,
                                             const Eigen::VectorXcd& roots) {
  const Eigen::Index size = polynomial.size();
  std::vector<Eigen::Matrix2d> all;
  for (const Complex z : roots) {
    Complex slope = 0.0, power = 1.0;  // dP/dz
    Eigen::VectorXcd powers(size);
    for (Eigen::Index i = size - 1; i >= 0; --i) {
      powers[i] = power;
      if (i > 0) slope += static_cast<double>(size - i) * polynomial[i - 1] * power;
      power *= z;
    }
    Eigen::MatrixXd change(2, size);
    change.row(0) = (-powers / slope).real().transpose();
    change.row(1) = (-powers / slope).imag().transpose();
    all.emplace_back(change * covariance * change.transpose());
  }
  return all;
}

Expected<std::vector<Pole>> poles(const Model& model, const Eigen::MatrixXd& covariance, double sample_time) {
  const Eigen::Index n = model.order();
  if (!(sample_time > 0.0) || !std::isfinite(sample_time)) return refused("the sample time must be above 0 s and finite");
  if (covariance.rows() < n || covariance.cols() < n) {
    return refused("the covariance must be at least " + std::to_string(n) + " x " + std::to_string(n));
  }
  const auto roots = numerics::roots(model.a);
  if (!roots) return tl::make_unexpected(roots.error());
  Eigen::MatrixXd of_a = Eigen::MatrixXd::Zero(n + 1, n + 1);
  of_a.bottomRightCorner(n, n) = covariance.topLeftCorner(n, n);
  const auto spread = root_covariance(model.a, of_a, *roots);
  std::vector<Pole> found;
  for (std::size_t i = 0; i < spread.size(); ++i) {
    Pole p;
    p.z = (*roots)[static_cast<Eigen::Index>(i)];
    p.z_covariance = spread[i];
    p.s_rad_s = std::log(p.z) / sample_time;
    const double size = std::abs(p.s_rad_s);
    p.frequency_hz = size / (2.0 * std::numbers::pi);
    p.damping_ratio = -p.s_rad_s.real() / size;
    const Eigen::Matrix2d of_s = scaled(spread[i], 1.0 / (p.z * sample_time));
    p.real_std_rad_s = std::sqrt(of_s(0, 0));
    p.imaginary_std_rad_s = std::sqrt(of_s(1, 1));
    const Eigen::Vector2d outward(p.s_rad_s.real() / size, p.s_rad_s.imag() / size);
    p.frequency_std_hz = std::sqrt(outward.dot(of_s * outward)) / (2.0 * std::numbers::pi);
    found.push_back(p);
  }
  return found;
}

}  // namespace bodeflow::koopmans_levin
